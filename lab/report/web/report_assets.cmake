# The report's page, style, script and plotting library as one generated source.
# footfall_add_report_assets(TARGET) adds it to TARGET's sources. The library is installed by `npm
# ci` from the lock file beside this one, at build time. Without npm, without network, or with
# FOOTFALL_REPORT_SVG the report draws its plots as SVG instead.
option(FOOTFALL_REPORT_SVG "Draw the report's plots as SVG even where npm is there" OFF)

set(FOOTFALL_REPORT_WEB ${CMAKE_CURRENT_LIST_DIR})

function(footfall_add_report_assets target)
  set(web ${FOOTFALL_REPORT_WEB})
  set(out ${CMAKE_CURRENT_BINARY_DIR}/report_assets)
  set(npm "${NPM_PROGRAM}")
  if(FOOTFALL_REPORT_SVG OR NOT NPM_PROGRAM)
    set(npm "")
    message(STATUS "report: plots as SVG (no npm, or FOOTFALL_REPORT_SVG)")
  endif()
  # The stamp's name encodes the configuration, so that a changed option rebuilds it.
  string(MD5 way "${npm}")
  add_custom_command(OUTPUT ${out}/uplot-${way}.stamp
    COMMAND ${CMAKE_COMMAND} "-DNPM=${npm}" -DWEB=${web} -DOUT=${out} -P ${web}/fetch.cmake
    COMMAND ${CMAKE_COMMAND} -E touch ${out}/uplot-${way}.stamp
    DEPENDS ${web}/package.json ${web}/package-lock.json ${web}/fetch.cmake
    COMMENT "Report: plotting library" VERBATIM)
  add_custom_command(OUTPUT ${out}/report_assets.cc
    COMMAND ${CMAKE_COMMAND} -DWEB=${web} -DOUT=${out} -P ${web}/embed.cmake
    DEPENDS ${out}/uplot-${way}.stamp ${web}/report.html ${web}/report.css ${web}/report.js
            ${web}/report_keys.js ${web}/embed.cmake
    COMMENT "Report: page" VERBATIM)
  target_sources(${target} PRIVATE ${out}/report_assets.cc)
endfunction()
