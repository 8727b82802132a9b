"""Scripts made to harm whoever runs them: families of Lua texts, most of them a body and the values that go into it.

`SCRIPTS` is a list of (name, text, where). `where`: "function" is the body of a function, to be placed where code may run;
"file" a whole file; "files" and "processes" a body for a run with that permission.
"""
SPIN = "while true do end"
SHORT, LONG = "1e4", "2e5"  # bytes of a subject


def each(template, *values):
    """The template with each value in the place of @; the name is the value."""
    return [(str(value), template.replace("@", str(value))) for value in values]


def pairs(template, firsts, seconds):
    return [(f"{a} {b}", template.replace("@1", str(a)).replace("@2", str(b))) for a in firsts for b in seconds]


# Of one metamethod each: `t` is the operand.
METAMETHODS = {
    "__index": "return t.x", "__newindex": "t.x = 1", "__call": "t()", "__eq": "return t == u", "__lt": "return t < u",
    "__le": "return t <= u", "__concat": "return t .. 'x'", "__len": "return #t", "__unm": "return -t", "__add": "return t + 1",
    "__band": "return t & 1", "__tostring": "footfall.log(t)", "__pairs": "for _ in pairs(t) do end", "__close": "local x <close> = t",
}

FUNCTIONS = {
    "endless loop": [
        ("while", SPIN),
        ("repeat", "repeat until false"),
        ("for of integers", "for i = 1, math.maxinteger do end"),
        ("for of floats", "for i = 1.0, math.huge do end"),
        ("nested", "for i = 1, 1e9 do for j = 1, 1e9 do end end"),
        ("goto", "::a:: goto a"),
        ("goto with closures", "::a:: local x = function() return x end goto a"),
        ("goto two places", "::a:: goto b ::b:: goto a"),
        ("tail calls", "local function g() return g() end g()"),
        ("two tail calls", "local g, h function g() return h() end function h() return g() end g()"),
        ("arithmetic", "local x = 0 while true do x = math.sin(x) + x // 3 end"),
        ("next", "while true do next({}) end"),
        ("iterator", "for x in function() return 1 end do end"),
        ("ipairs without end", "for i in ipairs(setmetatable({}, {__index = function() return 1 end})) do end"),
        ("select", "while true do select('#', 1, 2, 3) end"),
    ],
    "errors swallowed": each("while true do @ end",
                             "pcall(function() while true do end end)", "pcall(error)", "pcall(pcall, error)",
                             "xpcall(error, function() end)", "pcall(string.rep)", "pcall(nil)",
                             "pcall(function() local x <close> = setmetatable({}, {__close = error}) end)") + [
        ("a handler that spins", f"xpcall(function() {SPIN} end, function() {SPIN} end)"),
        ("a handler that fails", f"xpcall(function() {SPIN} end, function(e) error(e) end)"),
        ("a handler that calls on", f"local function h() xpcall(error, h) {SPIN} end xpcall(error, h)"),
        ("pcall of itself", "local function g() pcall(g) return g() end g()"),
        ("pcall in a close", f"local x <close> = setmetatable({{}}, {{__close = function() while true do pcall(error) end end}}) {SPIN}"),
        ("coroutines that catch", f"while true do coroutine.resume(coroutine.create(function() {SPIN} end)) end"),
    ],
    "pattern": pairs(f"string.@1(('a'):rep({SHORT}), '@2', @3)".replace(", @3", ""), ("find", "match"),
                     (".-.-.-.-b$", ".*.*.*.*b", "a-a-a-a-b", "^(.-)(.-)(.-)(.-)b")) +
               pairs(f"string.gsub(('a'):rep({SHORT}), '@1', '@2')", (".-.-.-b", "%w*%w*%w*b"), ("", "x")) + [
        ("gmatch", f"for x in string.gmatch(('a'):rep({SHORT}), '.-.-.-b') do end"),
        ("optional items", "string.find(('a'):rep(30), ('a?'):rep(30) .. ('a'):rep(30) .. 'b')"),
        ("balanced", f"string.find(('('):rep({LONG}), '%b()')"),
        ("frontier", f"string.find(('a'):rep({LONG}), '%f[b].-.-c')"),
        ("back references", f"string.find(('a'):rep({SHORT}), '(a-)%1(a-)%2(a-)%3b')"),
        ("a long set", f"string.find(('a'):rep({SHORT}), ('[' .. ('b'):rep(1e4) .. ']'):rep(10))"),
        ("plain find", "local s = ('a'):rep(4e6) while true do string.find(s, ('a'):rep(1e6) .. 'b', 1, true) end"),
        ("a replacement that spins", f"string.gsub('abc', '.', function() {SPIN} end)"),
        ("a replacement that grows", "local s = 'x' while true do s = string.gsub(s, '.', '%0%0') end"),
        ("a replacement that calls on", "local function g(s) return string.gsub(s, '.', g) end g('x')"),
        ("too deep", "string.find(('a'):rep(1e6), ('(a'):rep(40) .. (')'):rep(40))"),
        ("malformed", "string.find('a', '[')"),
    ],
    "work in C": [
        ("rep of nothing", "string.rep('', 1e18)"),
        ("rep with a separator of nothing", "string.rep('', math.maxinteger, '')"),
        ("rep too large", "string.rep('x', 1e12)"),
        ("move", "table.move({}, 1, math.maxinteger - 1, 2)"),
        ("move backwards", "table.move({}, -1e17, 1e17, 1 - 1e17)"),
        ("insert with a length", "table.insert(setmetatable({}, {__len = function() return 1 << 60 end}), 1, 0)"),
        ("remove with a length", "table.remove(setmetatable({}, {__len = function() return 1 << 60 end}), 1)"),
        ("concat of what is not there", "table.concat(setmetatable({}, {__index = function() return '' end}), '', 1, math.maxinteger - 1)"),
        ("concat of holes", "table.concat({}, 'x', 1, 1e9)"),
        ("unpack", "table.unpack({}, 1, 1e7)"),
        ("unpack in a loop", "while true do pcall(table.unpack, {}, 1, 1e6) end"),
        ("sort that is always true", "local t = {} for i = 1, 1e5 do t[i] = i end table.sort(t, function() return true end)"),
        ("sort at random", "local t = {} for i = 1, 1e5 do t[i] = i end table.sort(t, function() return math.random() < 0.5 end)"),
        ("sort that spins", f"table.sort({{3, 2, 1}}, function() {SPIN} end)"),
        ("sort with a length", "table.sort(setmetatable({}, {__len = function() return (1 << 31) - 2 end, __index = function() return 1 end}))"),
        ("sort again and again", "local t = {} for i = 1, 1e6 do t[i] = -i end while true do table.sort(t) table.sort(t, function(a, b) return a > b end) end"),
        ("sort that changes", "local t = {} for i = 1, 1e4 do t[i] = i end table.sort(t, function(a, b) t[#t + 1] = 1 return a < b end)"),
        ("next on an emptied table", "local t = {} for i = 1, 1e6 do t[i] = i end for i = 1, 1e6 do t[i] = nil end while next(t) == nil do end"),
        ("reverse", "local s = ('x'):rep(1e7) while true do s = s:reverse() end"),
        ("upper", "local s = ('x'):rep(1e7) while true do s = s:upper() end"),
        ("byte", "local s = ('x'):rep(1e6) while true do pcall(string.byte, s, 1, -1) end"),
        ("compare", "local a, b = ('x'):rep(2e7), ('x'):rep(2e7 - 1) .. 'y' while a < b do end"),
        ("pack", "while true do string.pack('z', ('x'):rep(1e6)) end"),
        ("unpack a format", "string.unpack(('b'):rep(1e6), ('x'):rep(1e6))"),
        ("tonumber", "local s = ('1'):rep(1e7) while true do tonumber(s) end"),
    ],
    "format": each("local s = '' while true do s = string.format(@) end", "'%99.99f', 1e308", "'%-99d', 1", "'%q', ('\\0'):rep(1e6)",
                   "'%s', ('x'):rep(1e6)", "('%%'):rep(1e5)", "'%a', 0/0") + [
        ("a width too large", "string.format('%999d', 1)"),
        ("grows", "local s = 'x' while true do s = string.format('%s%s', s, s) end"),
        ("an object that spins", f"string.format('%s', setmetatable({{}}, {{__tostring = function() {SPIN} end}}))"),
        ("an object that calls on", "local t = {} setmetatable(t, {__tostring = function() return string.format('%s', t) end}) string.format('%s', t)"),
    ],
    "utf8": [
        ("char", "while true do utf8.char(table.unpack({0x10FFFF, 0x10FFFF, 0x10FFFF})) end"),
        ("codes", "for _ in utf8.codes(('x'):rep(2e7)) do end"),
        ("codes of nonsense", "for _ in utf8.codes('\\xff\\xfe') do end"),
        ("len", "local s = ('x'):rep(2e7) while true do utf8.len(s) end"),
        ("codepoint", "while true do pcall(utf8.codepoint, ('x'):rep(1e6), 1, -1) end"),
        ("offset", "local s = ('\\x80'):rep(2e7) while true do pcall(utf8.offset, s, 1, #s) end"),
        ("charpattern", "local s = ('x'):rep(1e6) while true do s:gsub(utf8.charpattern, '') end"),
    ],
    "coroutine": [
        ("wrap", f"coroutine.wrap(function() {SPIN} end)()"),
        ("yields for ever", "local c = coroutine.wrap(function() while true do coroutine.yield() end end) while true do c() end"),
        ("inside pcall", f"pcall(coroutine.wrap(function() {SPIN} end))"),
        ("pcall inside", f"coroutine.wrap(function() while true do pcall(function() {SPIN} end) end end)()"),
        ("one in another", "local function g() return coroutine.wrap(g)() end g()"),
        ("one in another, caught", "local function g() while true do pcall(coroutine.wrap(g)) end end g()"),
        ("a chain of many", "local f = function() end for i = 1, 1e6 do local g = f f = coroutine.wrap(function() g() end) end f()"),
        ("resumes itself", "local c c = coroutine.create(function() while true do coroutine.resume(c) end end) coroutine.resume(c)"),
        ("yield outside", "coroutine.yield()"),
        ("yield outside, caught", "while true do pcall(coroutine.yield) end"),
        ("close that spins", f"local c = coroutine.create(function() local x <close> = setmetatable({{}}, {{__close = function() {SPIN} end}}) coroutine.yield() end) coroutine.resume(c) coroutine.close(c)"),
        ("many", "local t = {} while true do t[#t + 1] = coroutine.create(function() end) end"),
        ("many that wait", "local t = {} while true do local c = coroutine.wrap(coroutine.yield) c() t[#t + 1] = c end"),
        ("kept between calls", f"kept = kept or coroutine.wrap(function() while true do coroutine.yield() for i = 1, 1e9 do end end end) kept()"),
        ("yields out of a sort", "coroutine.wrap(function() table.sort({3, 2, 1}, function() coroutine.yield() end) end)()"),
    ],
    "metamethod that spins": [(name, f"local m = {{{name} = function() {SPIN} end}} local t, u = setmetatable({{}}, m), setmetatable({{}}, m) {use}")
                              for name, use in METAMETHODS.items()],
    "metamethod that calls on": [(name, f"local t, u local m = {{{name} = function() {use} end}} t, u = setmetatable({{}}, m), setmetatable({{}}, m) {use}")
                                 for name, use in METAMETHODS.items() if name != "__pairs"],
    "metatable": [
        ("an index of itself", "local t = {} setmetatable(t, {__index = t}) return t.x"),
        ("a circle", "local a, b = {}, {} setmetatable(a, {__index = b}) setmetatable(b, {__index = a}) return a.x"),
        ("a long chain", "local t = {} for i = 1, 1e5 do t = setmetatable({}, {__index = t}) end return t.x"),
        ("of strings", f"getmetatable('').__index = function() {SPIN} end local s = 'x' return s.y"),
        ("of strings, added", f"getmetatable('').__add = function() {SPIN} end return 'x' + 1"),
        ("of the globals, spins", f"f = nil setmetatable(_G, {{__index = function() {SPIN} end}})"),
        ("of the globals, fails", "f = nil setmetatable(_G, {__index = function() error('no') end})"),
        ("of the globals, spins in C", "f = nil setmetatable(_G, {__index = function() table.move({}, 1, math.maxinteger - 1, 2) end})"),
        ("new globals spin", f"setmetatable(_G, {{__newindex = function() {SPIN} end}}) x = 1"),
        ("protected", "setmetatable(_G, {__metatable = 1}) setmetatable(_G, {})"),
        ("a finalizer", f"setmetatable({{}}, {{__gc = function() {SPIN} end}})"),
        ("a finalizer, later", f"local m = {{}} local t = setmetatable({{}}, m) m.__gc = function() {SPIN} end t = nil for i = 1, 1e5 do t = {{}} end"),
        ("weak", "local t = setmetatable({}, {__mode = 'kv'}) while true do t[{}] = {} end"),
    ],
    "memory": [
        ("doubling", "local s = 'x' while true do s = s .. s end"),
        ("doubling, caught", "local s = 'x' while true do pcall(function() s = s .. s end) end"),
        ("a list", "local t = {} while true do t[#t + 1] = t end"),
        ("a list kept", "kept = kept or {} while true do kept[#kept + 1] = 1 end"),
        ("keys", "local t = {} while true do t[math.random()] = true end"),
        ("texts", "local t = {} while true do t[#t + 1] = tostring(math.random()) end"),
        ("closures", "local t = {} while true do t[#t + 1] = function() return t end end"),
        ("nested lists", "local t = {} while true do t = {t} end"),
        ("full to the last byte", "kept = kept or {} local n = 1 << 24 while n > 0 do local good, s = pcall(string.rep, 'x', n) if good then kept = {s, kept} else n = n // 2 end end"),
        ("full, then on", "kept = kept or {} while true do pcall(function() kept = {kept, ('x'):rep(1e6)} end) end"),
        ("varargs", "local function g(...) return g(1, ...) end g()"),
        ("concat of many", "local t = {} for i = 1, 1e6 do t[i] = ('x'):rep(100) end return table.concat(t)"),
        ("one large table", "local t = table.pack(('x'):rep(2e5):byte(1, -1)) while true do t = {t, table.unpack(t, 1, 2e5)} end"),
        ("garbage", "while true do local t = {{}, {}, {}, 'x' .. math.random()} end"),
        ("collectgarbage", "collectgarbage('stop')"),
        ("collectgarbage, caught", "while true do pcall(collectgarbage, 'collect') end"),
    ],
    "recursion": [
        ("plain", "local function g() return 1 + g() end g()"),
        ("two functions", "local g, h function g() return 1 + h() end function h() return 1 + g() end g()"),
        ("through pcall", "local function g() pcall(g) end g()"),
        ("through sort", "local function g() table.sort({3, 2, 1}, g) end g()"),
        ("through tostring", "local t t = setmetatable({}, {__tostring = function() return tostring(t) end}) tostring(t)"),
        ("of errors", "local function g(e) error(e, 0) end xpcall(g, g)"),
        ("many locals", "local function g() " + " ".join(f"local a{i} = {i}" for i in range(190)) + " return g() + 1 end g()"),
        ("through footfall.log", "local t t = setmetatable({}, {__tostring = function() footfall.log(t) return '' end}) footfall.log(t)"),
    ],
    "error": each("error(@)", "", "nil", "{}", "function() end", "('x'):rep(1e7)", "'\\27[2J\\xff\\0'", "7, 1e9", "f",
                  "setmetatable({}, {__tostring = function() while true do end end})",
                  "setmetatable({}, {__tostring = function() error('again') end})", "setmetatable({}, {__name = ('x'):rep(1e6)})") +
             each("@", "assert(false, {})", "local x = nil + 1", "local x = 1 // 0", "string.rep(nil)", "return #5"),
    "what is not there": each("@", "load('while true do end')()", "loadfile('/dev/zero')", "dofile('/dev/stdin')", "require('os')", "string.dump(f)",
                              "debug.sethook()", "debug.getregistry()[1] = nil", "os.exit(0)", "os.execute('sleep 100')", "io.read('a')",
                              "io.open('/dev/zero'):read('a')", "io.popen('sleep 100'):read()", "package.loadlib('/dev/null', '*')",
                              "print(('x'):rep(1e6))", "while true do pcall(load, 'x') end"),
    "footfall": [
        ("events without end", "while true do footfall.raise('go') end"),
        ("events without end, caught", "while true do pcall(footfall.raise, 'go') end"),
        ("edits without end, caught", "while true do pcall(footfall.set, 'clearance', 0.06) end"),
        ("texts without end, caught", "while true do pcall(footfall.log, ('x'):rep(2000)) end"),
        ("a long text", "footfall.log(('\\xff'):rep(3e7))"),
        ("a name with a zero", "footfall.raise('go\\0')"),
        ("a long name", "footfall.get(('x'):rep(1e7))"),
        ("a value that is none", "footfall.set('clearance', 0/0)"),
        ("a value without end", "footfall.set('clearance', math.huge)"),
        ("a list with a length", "footfall.set('goal', setmetatable({}, {__len = function() while true do end end}))"),
        ("handlers within", "while true do footfall.on('go', function() end) end"),
        ("the table gone", "footfall = nil footfall.log('x')"),
        ("libraries gone", "string, table, math, pairs, setmetatable = nil f()"),
        ("names of signals", "while true do pcall(footfall.get, 'com') end"),
        ("a text that spins", f"footfall.log(setmetatable({{}}, {{__tostring = function() {SPIN} end}}))"),
        ("a text that spins in C", "footfall.log(setmetatable({}, {__tostring = function() string.rep('', 1e18) end}))"),
    ],
}
FILES = {
    "a file": [
        ("empty", ""), ("zeros", "\0" * 1000), ("byte code", "\x1bLuaT\0\x19\x93\r\n\x1a\n"), ("not closed", "function f("),
        ("parentheses", "x = " + "(" * 100_000), ("braces", "x = " + "{" * 100_000), ("functions", "return " + "function() return " * 100_000),
        ("blocks", "do " * 100_000), ("concatenation", "x = 'a'" + " .. 'a'" * 300_000), ("minus signs", "x = " + "- " * 300_000 + "1"),
        ("locals", "\n".join(f"local a{i}" for i in range(300))), ("names", "\n".join(f"x{i} = {i}" for i in range(300_000))),
        ("a long text", "x = '" + "y" * 5_000_000 + "'"), ("a long comment", "--[==[" + "]=]" * 2_000_000), ("labels", "\n".join(f"::a{i}:: goto a{i + 1}" for i in range(20_000))),
        ("many handlers", "for i = 1, 1e6 do footfall.on('go', function() end) end"), ("a handler of all", "footfall.on('*', function(e) footfall.raise('go') end)"),
        ("functions without number", "for i = 1, 2e5 do _G['f' .. i] = function() end end"), ("calls itself", "footfall.on('go', function() footfall.raise('go') footfall.raise('go') end)"),
        ("sees no robot", "footfall.set('clearance', 1)"),
    ],
}
PERMITTED = {
    "files": each("@", "io.open('/dev/zero'):read('a')", "while true do pcall(io.open, '/') end", "for line in io.lines('/dev/zero') do end",
                  "io.open('/dev/full', 'w'):write(('x'):rep(1e6)):close()",
                  "getmetatable(io.open('/dev/null')).__gc = function() while true do end end",
                  "kept = io.open('/dev/null') getmetatable(kept).__gc = function() while true do end end",
                  "kept = {} while true do kept[#kept + 1] = io.open('/dev/null') end"),
    "processes": each("@", "os.execute('sleep 20')", "io.popen('sleep 20'):read('a')", "kept = io.popen('sleep 20')", "io.popen('yes'):read('a')",
                      "while true do os.execute('true') end"),
}


def listed(families, where=None):
    return [(f"{family}: {name}", text, where or family) for family, scripts in families.items() for name, text in scripts]


SCRIPTS = listed(FUNCTIONS, "function") + listed(FILES, "file") + listed(PERMITTED)
