-- For every_key.yaml: a function to call.
function greet()
  footfall.log("goes")
end
