# SPDX-License-Identifier: GPL-3.0-or-later
set(map_libs taut::case taut::map taut::certificate TBB::tbb fmt::fmt)
foreach(header map_space subdivision parts topology outline region singular both_limits)
  taut_add_test(map ${header} LABELS unit LIBS ${map_libs} TOGETHER)
endforeach()
taut_add_test(map cell_proof LABELS unit LIBS ${map_libs} TOGETHER COST 30)
taut_add_test(map no_path LABELS unit LIBS ${map_libs} TOGETHER COST 20)
taut_add_test(map raster LABELS slow LIBS ${map_libs} TOGETHER TIMEOUT 1800)
