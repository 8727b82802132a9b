-- For behavior.yaml: a function to call.
function greet()
  footfall.log("goes")
end
