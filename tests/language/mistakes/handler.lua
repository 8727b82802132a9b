function hear() end
footfall.on("fault", hear)
