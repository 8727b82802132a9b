-- Runs beside the control loop, never in it: what it asks for arrives with the next tick at the earliest.
local touchdowns = 0

footfall.on("contact.left_foot.touchdown", function()
  touchdowns = touchdowns + 1
  if touchdowns == 40 then
    footfall.raise("tired")
  elseif touchdowns % 10 == 0 then
    footfall.raise("bored")
  end
end)

function pick()
  local x, y = math.random(-20, 20) / 100, math.random(-20, 20) / 100
  footfall.set("goal", {x, y})
  footfall.log(string.format("goes to %g m, %g m after %d steps", x, y, footfall.get("steps")))
end
