# SPDX-License-Identifier: GPL-3.0-or-later
foreach(header manifold polytope sampled_polytope neighbour_index atlas wrench_feasible_manifold topology atlas_file
    search)
  taut_add_test(atlas ${header} LABELS unit LIBS taut::case taut::atlas TOGETHER)
endforeach()
target_sources(atlas_tests PRIVATE atlas/topology.cc)
foreach(header edge_motion shorten detours path_length sampled_motion_validator time_optimal move_fit)
  taut_add_test(atlas ${header} LABELS unit LIBS taut::planner TOGETHER)
endforeach()
