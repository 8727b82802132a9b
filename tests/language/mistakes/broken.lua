function wave()
  footfall.log("hello"
end
