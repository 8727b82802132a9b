-- For scenario.yaml: a function to call.
function slower()
  footfall.set("lift_time", 0.16)
end
