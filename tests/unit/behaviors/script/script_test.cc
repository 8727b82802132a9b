// Lua scripts: what they see, what they may do, and what stops them.
#include "behaviors/script/script.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <memory>

#include "behaviors/script/watched.h"
#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

using behaviors::Script;
using behaviors::ScriptAnswer;
using behaviors::ScriptError;
using behaviors::ScriptSettings;
using behaviors::ScriptView;

// A behavior with two parameters and an event, its values, and a script beside it.
struct Bench {
  explicit Bench(const std::string& text, const ScriptSettings& settings = {}) : script(settings) {
    behavior = load(R"(
behavior: 1
parameters: {speed: {value: 1 m/s, range: [0 m/s, 2 m/s], live: true}, goal: [0, 0]}
events: {tapped: "", go: ""}
machine: {states: {a: {transitions: [{on: go, to: b}]}, b: {}}}
)");
    active.assign(behavior->states.size(), 0);
    active[1] = 1;
    loaded = script.load(text, error);
    view = {behavior.get(), behavior->signals.values(), behavior->values.data(), active.data(),
            2.5};
  }
  bool call(const std::string& name) { return script.call(name, view, answer); }

  Script script;
  std::unique_ptr<behaviors::Behavior> behavior;
  std::vector<std::uint8_t> active;
  bool loaded = false;
  ScriptError error;
  ScriptView view;
  ScriptAnswer answer;
};

TEST(Script, AFunctionSeesTheRobotAndAnswersWithEventsAndParameters) {
  Bench bench(R"(
function fast()
  if footfall.active("a") and footfall.time() == 2.5 and footfall.parameter("speed") == 1 then
    footfall.set("speed", 1.5)
    footfall.set("goal", {3, 4})
    footfall.set("goal.y", 5)
    footfall.raise("go")
    footfall.log("now " .. footfall.parameter("goal"))
  end
end)");
  ASSERT_TRUE(bench.loaded) << bench.error.text;
  EXPECT_EQ(bench.script.functions(), Lines{"fast"});
  ASSERT_TRUE(bench.call("fast"));
  ASSERT_EQ(bench.answer.edits.size(), 4U);
  const int speed = bench.behavior->parameters[0].slot, goal = bench.behavior->parameters[1].slot;
  EXPECT_EQ(bench.answer.edits[0].slot, speed);
  EXPECT_EQ(bench.answer.edits[0].value, 1.5);
  EXPECT_EQ(bench.answer.edits[2].slot, goal + 1);
  EXPECT_EQ(bench.answer.edits[3].value, 5.0);
  ASSERT_EQ(bench.answer.events.size(), 1U);
  EXPECT_EQ(bench.answer.events[0], bench.behavior->find_event("go"));
  EXPECT_EQ(bench.answer.messages, Lines{"now 0.0"});
}

TEST(Script, HandlersMatchEventsAsTransitionsDo) {
  Bench bench(R"(
footfall.on("fault.*", function(event) footfall.log(event) end)
footfall.on("tapped", function() footfall.log("tapped") end))");
  ASSERT_TRUE(bench.loaded) << bench.error.text;
  EXPECT_EQ(bench.script.patterns(), (Lines{"fault.*", "tapped"}));
  EXPECT_TRUE(bench.script.handle("fault.fall", bench.view, bench.answer));
  EXPECT_TRUE(bench.script.handle("faulty", bench.view, bench.answer));
  EXPECT_TRUE(bench.script.handle("tapped", bench.view, bench.answer));
  EXPECT_EQ(bench.answer.messages, (Lines{"fault.fall", "tapped"}));
}

TEST(Script, AMistakeNamesItsLineAndDropsWhatTheCallAskedFor) {
  Bench bench("function f()\n footfall.raise('go')\n footfall.raise('tappd')\nend");
  EXPECT_FALSE(bench.call("f"));
  EXPECT_TRUE(bench.answer.events.empty());
  EXPECT_EQ(bench.answer.messages,
            Lines{"script error: line 3: unknown event 'tappd' (did you mean 'tapped'?)"});
  EXPECT_FALSE(bench.script.load("function g(\n", bench.error));
  EXPECT_EQ(bench.error.line, 2);
}

TEST(Script, AValueOutsideItsRangeIsRefused) {
  Bench bench(
      "function f() footfall.set('speed', 3) end function g() footfall.set('speed', 0/0) end");
  EXPECT_FALSE(bench.call("f"));
  EXPECT_FALSE(bench.call("g"));
  EXPECT_TRUE(bench.answer.edits.empty());
}

TEST(Script, AnEndlessLoopIsStoppedEvenIfItCatchesErrors) {
  Bench bench(R"(
function f() while true do pcall(function() while true do end end) end end
function g() local co = coroutine.wrap(function() while true do end end) co() end)",
              {{}, 0, 200'000});
  EXPECT_FALSE(bench.call("f"));
  EXPECT_FALSE(bench.call("g"));
  EXPECT_NE(bench.answer.messages[0].find("ran longer"), std::string::npos);
  EXPECT_TRUE(bench.script.load("function h() end", bench.error));
  EXPECT_TRUE(bench.call("h")) << "the next call has a budget of its own";
}

TEST(Script, MemoryIsBounded) {
  Bench bench("function f() local t = {} while true do t[#t + 1] = string.rep('x', 1000) end end",
              {{}, 0, {1'000'000'000}, 4'000'000});
  EXPECT_FALSE(bench.call("f"));
  EXPECT_NE(bench.answer.messages[0].find("more memory"), std::string::npos);
}

// What a call needs before its function runs may fail as well; outside of a protected call that
// would end the process.
TEST(Script, AFunctionThatCannotEvenBeSoughtIsAnError) {
  Bench bench(R"(
function f()
  f = nil
  setmetatable(_G, {__index = function() error("no such thing") end})
end
function g()
  g = nil
  setmetatable(_G, {__index = function() while true do end end})
end)");
  EXPECT_TRUE(bench.call("f"));
  EXPECT_FALSE(bench.call("f"));
  EXPECT_NE(bench.answer.messages.at(0).find("no such thing"), std::string::npos);
  EXPECT_TRUE(bench.call("g"));
  EXPECT_FALSE(bench.call("g"));
  EXPECT_NE(bench.answer.messages.at(1).find("ran longer"), std::string::npos);
}

TEST(Script, AnEventForAScriptWithoutAnyMemoryLeftIsAnError) {
  Bench bench(R"(
footfall.on("*", function() end)
function f()
  local size = 1 << 20
  while size > 0 do
    local good, text = pcall(string.rep, "x", size)
    if good then kept = {text, kept} else size = size // 2 end
  end
end)",
              {{}, 0, {}, 1'000'000});
  EXPECT_FALSE(bench.call("f"));
  const std::string event(5000, 'e');
  EXPECT_FALSE(bench.script.handle(event, bench.view, bench.answer));
  EXPECT_FALSE(bench.call(event));
  EXPECT_NE(bench.answer.messages.back().find("more memory"), std::string::npos);
}

TEST(Script, FilesProcessesAndClocksAreOutOfReach) {
  for (const char* text : {"io.open('x')", "os.execute('true')", "os.remove('x')", "os.time()",
                           "dofile('x')", "load('return 1')", "require('x')", "debug.getinfo(1)"}) {
    Bench bench(std::string("function f() ") + text + " end");
    ASSERT_TRUE(bench.loaded) << text;
    EXPECT_FALSE(bench.call("f")) << text;
  }
  Bench bench("function f() io.open('/nowhere/x') end");
  EXPECT_FALSE(bench.call("f"));
  EXPECT_NE(bench.answer.messages[0].find("footfall run --allow files"), std::string::npos);
}

// What a script calls that is not there says what to use instead.
TEST(Script, AFunctionThatIsNotThereNamesWhatToUse) {
  const std::vector<std::array<std::string, 2>> cases = {
      {"print('x')", "line 1: print is not there: use footfall.log(TEXT)"},
      {"os.time()", "line 1: os.time is not there: runs must repeat: footfall.time()"},
      {"os.clock()", "footfall.time()"},
      {"os.getenv('HOME')", "--allow"},
      {"io.write('x')", "--allow files"},
      {"require('x')", "name all Lua files in the behavior's `scripts:`"},
      {"load('return 1')", "`scripts:`"},
      {"math.randomseed(1)", "--seed"},
      {"debug.traceback()", "debug.traceback is not there"},
      {"package.loaded.x = 1", "package.loaded is not there"},
      {"collectgarbage()", "cleaned up by itself"},
      {"setmetatable({}, {__gc = function() end})", "__gc is not there"},
  };
  for (const auto& [call, said] : cases) {
    Bench bench("function f() " + call + " end");
    ASSERT_TRUE(bench.loaded) << call;
    EXPECT_FALSE(bench.call("f")) << call;
    EXPECT_NE(bench.answer.messages.at(0).find(said), std::string::npos)
        << call << ": " << bench.answer.messages[0];
  }
  // Permissions do not bring the clock.
  Bench allowed("function f() os.time() end", {{true, true}});
  EXPECT_FALSE(allowed.call("f"));
  EXPECT_NE(allowed.answer.messages.at(0).find("footfall.time()"), std::string::npos);
}

TEST(Script, AnErrorOfAnyTypeHasALine) {
  for (const char* error : {"error({code = 7})", "error(nil)", "error(42)", "error()"}) {
    Bench bench(std::string("function f()\n  ") + error + "\nend");
    EXPECT_FALSE(bench.call("f"));
    EXPECT_TRUE(bench.answer.messages.at(0).starts_with("script error: line 2: "))
        << error << ": " << bench.answer.messages[0];
  }
}

TEST(Script, AnErrorWithWordsOfItsOwnIsToldInThem) {
  const auto message = [](const std::string& words) {
    Bench bench("function f()\n  error(setmetatable({}, {__tostring = " + words + "}))\nend");
    EXPECT_FALSE(bench.call("f"));
    return bench.answer.messages.at(0);
  };
  EXPECT_EQ(message("function() return 'my words' end"), "script error: line 2: my words");
  for (const char* none : {"function() return 7 end", "function() error('again') end", "5",
                           "function() while true do end end"}) {
    EXPECT_TRUE(message(none).starts_with("script error: line 2: "))
        << none << ": " << message(none);
  }
}

TEST(Script, AByteOrderMarkAndAProgramsLineAreSkippedAndLinesKeepTheirNumbers) {
  for (const char* head :
       {"\xEF\xBB\xBF", "#!/usr/bin/lua\n", "\xEF\xBB\xBF#!/usr/bin/env lua\n"}) {
    Bench bench(std::string(head) + "function f() end");
    EXPECT_TRUE(bench.loaded) << head << bench.error.text;
  }
  Bench bench("#!/usr/bin/lua\nfunction f( end");
  EXPECT_FALSE(bench.loaded);
  EXPECT_EQ(bench.error.line, 2);
}

// Functions of Lua's library count no instructions: half a second of backtracking each.
TEST(Script, WhatDoesNotComeBackIsGivenUp) {
  const std::string slow = "string.find(('a'):rep(1000), '.-.-.-b')";
  ScriptSettings settings;
  settings.limits.deadline = 0.02;
  const auto at_load = std::make_shared<Script>(settings);
  ScriptError error;
  EXPECT_FALSE(behaviors::load_watched(at_load, slow, error));
  EXPECT_NE(error.text.find("does not end"), std::string::npos) << error.text;
  EXPECT_FALSE(behaviors::load_watched(at_load, "x = 1", error));  // never used again

  Bench bench("function f() end");
  const auto script = std::make_shared<Script>(settings);
  ASSERT_TRUE(behaviors::load_watched(
      script, "function f() " + slow + " footfall.set('speed', 1) end function g() end", error));
  EXPECT_TRUE(behaviors::call_watched(script, "g", bench.view, bench.answer));
  EXPECT_FALSE(behaviors::call_watched(script, "f", bench.view, bench.answer));
  EXPECT_NE(bench.answer.messages.at(0).find("does not end"), std::string::npos);
  EXPECT_TRUE(bench.answer.edits.empty());
  EXPECT_FALSE(behaviors::call_watched(script, "g", bench.view, bench.answer));
}

TEST(Script, ARunMayAllowFilesWithoutProcesses) {
  Bench bench("function f() return io.open('/nowhere/x') end function g() io.popen('true') end",
              {{true, false}});
  EXPECT_TRUE(bench.call("f"));
  EXPECT_FALSE(bench.call("g"));
}

TEST(Script, AFilesMetatableIsOutOfReach) {
  Bench bench("function f() getmetatable(io.open('/dev/null')).__gc = function() end end",
              {{true, false}});
  EXPECT_FALSE(bench.call("f"));
}

TEST(Script, AProgramLeftRunningDoesNotKeepTheScriptsEnd) {
  ScriptSettings settings;
  settings.access.processes = true;
  settings.limits.deadline = 0.02;  // of processor time; it waits for 1 s
  auto bench = std::make_unique<Bench>("function f() kept = io.popen('sleep 6') end", settings);
  ASSERT_TRUE(bench->call("f"));
  const auto begin = std::chrono::steady_clock::now();
  bench.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

TEST(Script, IterationAndRandomNumbersRepeat) {
  const char* text = R"(
function f()
  local t = {zeta = 1, alpha = 2, [3] = 3, mid = 4}
  local s = ""
  for key in pairs(t) do s = s .. key .. " " end
  footfall.log(s .. math.random(1000000))
end)";
  Bench one(text, {{}, 7}), other(text, {{}, 7}), third(text, {{}, 8});
  ASSERT_TRUE(one.call("f") && other.call("f") && third.call("f"));
  EXPECT_TRUE(one.answer.messages[0].starts_with("3 alpha mid zeta "));
  EXPECT_EQ(one.answer.messages, other.answer.messages);
  EXPECT_NE(one.answer.messages, third.answer.messages);
}

bool halve(behaviors::NativeCall& call) noexcept {
  call.parameters[0] *= 0.5;
  return call.parameters[0] > 1.0;
}

TEST(Script, ARegisteredFunctionRunsAtOnceAndItsFailureSkipsTheRestOfTheList) {
  behaviors::LoadOptions options = options_for_tests();
  options.functions = {{"halve", halve}};
  Runner run(load(chart(R"(
  on_entry: [{call: halve}, {set: {y: $x}}, {call: halve}, {set: {y: 99}}]
  transitions: [{on: error.execution, do: [{set: {failed: 1}}]}]
parameters: {x: 4, y: 0, failed: 0}
)"),
                  options));
  run.start();
  run.tick();
  EXPECT_EQ(run.parameter("y"), 2.0);
  EXPECT_EQ(run.parameter("x"), 1.0);
  EXPECT_EQ(run.parameter("failed"), 1.0);
}

}  // namespace
}  // namespace footfall::tests
