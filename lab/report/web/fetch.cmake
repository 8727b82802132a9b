# cmake -DNPM=... -DWEB=... -DOUT=... -P fetch.cmake: installs the plotting library to OUT by `npm
# ci`. If that fails, the files are empty, with a warning: the report then draws SVG.
set(files uPlot.iife.min.js uPlot.min.css LICENSE)
file(MAKE_DIRECTORY ${OUT})
foreach(file ${files})
  file(WRITE ${OUT}/${file} "")
endforeach()
if(NOT NPM)
  return()
endif()

file(COPY ${WEB}/package.json ${WEB}/package-lock.json DESTINATION ${OUT}/npm)
execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
  WORKING_DIRECTORY ${OUT}/npm RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE errors TIMEOUT 180)
set(uplot ${OUT}/npm/node_modules/uplot)
if(NOT result EQUAL 0 OR NOT EXISTS ${uplot}/dist/uPlot.iife.min.js)
  string(STRIP "${errors}" errors)
  message(WARNING "report: npm ci failed, plots will be SVG; to try again delete ${OUT}\n${errors}")
  return()
endif()
file(COPY ${uplot}/dist/uPlot.iife.min.js ${uplot}/dist/uPlot.min.css ${uplot}/LICENSE DESTINATION ${OUT})
file(REMOVE_RECURSE ${OUT}/npm/node_modules)
