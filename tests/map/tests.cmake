# SPDX-License-Identifier: GPL-3.0-or-later
taut_add_test(map map_space LABELS unit LIBS taut::case taut::map)
taut_add_test(map cell_proof LABELS unit LIBS taut::case taut::map fmt::fmt COST 30)
taut_add_test(map subdivision LABELS unit LIBS taut::case taut::map TBB::tbb)
taut_add_test(map topology LABELS unit LIBS taut::case taut::map)
taut_add_test(map outline LABELS unit LIBS taut::case taut::map)
taut_add_test(map region LABELS unit LIBS taut::case taut::map)
taut_add_test(map singular LABELS unit LIBS taut::case taut::map)
taut_add_test(map raster LABELS slow LIBS taut::case taut::map TBB::tbb TIMEOUT 1800)
