# SPDX-License-Identifier: GPL-3.0-or-later
find_package(CLI11 REQUIRED)
add_executable(soundness soundness/soundness.cc soundness/trial.cc soundness/body_judge.cc
  soundness/body_scene.cc)
target_link_libraries(soundness
  PRIVATE taut_common taut_case taut_certificate taut_certify taut_shards CLI11::CLI11 fmt::fmt)
target_compile_definitions(soundness PRIVATE TAUT_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
add_test(NAME soundness.campaign COMMAND soundness 500)
set_tests_properties(soundness.campaign PROPERTIES LABELS "laws" TIMEOUT 300)
add_test(NAME soundness.bodies COMMAND soundness 40 --bodies --kernels 8 --surveys 64)
set_tests_properties(soundness.bodies PROPERTIES LABELS "laws" TIMEOUT 300)
add_test(NAME soundness.larger_campaign_with_bodies COMMAND soundness 600 --bodies --kernels 8 --surveys 64)
set_tests_properties(soundness.larger_campaign_with_bodies PROPERTIES LABELS "slow" TIMEOUT 600)
add_test(NAME soundness.larger_campaign COMMAND soundness 3000)
set_tests_properties(soundness.larger_campaign PROPERTIES LABELS "slow" TIMEOUT 600)
add_test(NAME soundness.long_campaign COMMAND soundness 10000000 7 --budget 60)
set_tests_properties(soundness.long_campaign PROPERTIES LABELS "slow;nightly" TIMEOUT 900)
add_executable(moves_soundness soundness/moves.cc soundness/trial.cc)
target_link_libraries(moves_soundness
  PRIVATE taut_common taut_case taut_certificate taut_certify taut_shards CLI11::CLI11 fmt::fmt)
target_compile_definitions(moves_soundness PRIVATE TAUT_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
add_test(NAME soundness.moves COMMAND moves_soundness 500)
set_tests_properties(soundness.moves PROPERTIES LABELS "slow" TIMEOUT 600)
# That it would see an inertia that is wrong by a fiftieth.
add_test(NAME soundness.moves_of_a_wrong_mass COMMAND moves_soundness 100 --kernels 1000000000 --mass-error 0.02)
set_tests_properties(soundness.moves_of_a_wrong_mass PROPERTIES LABELS "slow" TIMEOUT 600
  PASS_REGULAR_EXPRESSION "\n[1-9][0-9]* WRONG")
