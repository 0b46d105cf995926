# SPDX-License-Identifier: GPL-3.0-or-later
# taut_add_test(<folder> <header> LABELS <label>… LIBS <target>… [PROGRAM <name>] [SHARDS <count>] [COST <seconds>]
#   [TIMEOUT <seconds>] [TOGETHER] [OPTIMIZED])
# compiles tests/<folder>/<header>_test.cc into the folder's test program, <folder>_test, and registers its tests as one
# ctest entry, <folder>.<header>. SHARDS makes it so many entries that run in parallel: <folder>.<header>.1 and so on.
# Files labelled laws are left out without TAUT_LAWS.
#
# Each file is an object library, so that it is compiled with the flags of what it links and of nothing else: the files
# that compute intervals with taut_rounding, the others without. Most tests take longer to compile than to run, so they
# are compiled with -O1, unless they compute much themselves (OPTIMIZED): the checker's computing is FLINT's and MPFR's.
# A folder's files that are TOGETHER are one object library, with the flags of all that they link, and another one of
# those that are OPTIMIZED. They are compiled several at a time: a name is no two files' own.
function(taut_add_test folder name)
  cmake_parse_arguments(ARG "TOGETHER;OPTIMIZED" "PROGRAM;SHARDS;COST;TIMEOUT" "LABELS;LIBS" ${ARGN})
  if(laws IN_LIST ARG_LABELS AND NOT TAUT_LAWS)
    return()
  endif()
  if(NOT ARG_PROGRAM)
    set(ARG_PROGRAM ${folder}_test)
  endif()
  set(objects ${folder}_${name}_test)
  if(ARG_TOGETHER)
    set(objects ${folder}_tests)
    if(ARG_OPTIMIZED)
      set(objects ${folder}_optimized_tests)
    endif()
  endif()
  if(NOT TARGET ${objects})
    add_library(${objects} OBJECT)
    if(ARG_TOGETHER)
      taut_unite(${objects} OPTIMIZED)
    endif()
  endif()
  target_sources(${objects} PRIVATE ${folder}/${name}_test.cc)
  target_link_libraries(${objects} PRIVATE taut_common ${ARG_LIBS} GTest::gtest GTest::gmock)
  target_compile_definitions(${objects} PRIVATE TAUT_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    TAUT_CERTIFICATES="${TAUT_CERTIFICATES}")
  if(NOT ARG_OPTIMIZED)
    target_compile_options(${objects} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  if(NOT TARGET ${ARG_PROGRAM})
    add_executable(${ARG_PROGRAM} support/main.cc)
    target_link_libraries(${ARG_PROGRAM} PRIVATE taut_common GTest::gtest GTest::gmock)
    add_dependencies(${ARG_PROGRAM} test_certificates)
  endif()
  target_link_libraries(${ARG_PROGRAM} PRIVATE ${objects} ${ARG_LIBS})

  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  if(TAUT_SANITIZE)
    math(EXPR ARG_TIMEOUT "3 * ${ARG_TIMEOUT}")  # sanitizers are slow
  endif()
  set(shard 0)
  set(test ${folder}.${name})
  set(environment)
  while(TRUE)
    if(ARG_SHARDS)
      set(environment "GTEST_TOTAL_SHARDS=${ARG_SHARDS};GTEST_SHARD_INDEX=${shard}")
      math(EXPR shard "${shard} + 1")
      set(test ${folder}.${name}.${shard})
    endif()
    add_test(NAME ${test} COMMAND ${ARG_PROGRAM} --file=${name}_test.cc WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}/tests")
    set_tests_properties(${test} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT} ENVIRONMENT "${environment}")
    if(ARG_COST)
      set_tests_properties(${test} PROPERTIES COST ${ARG_COST})  # the longest begin first
    endif()
    if(NOT ARG_SHARDS OR shard EQUAL ARG_SHARDS)
      break()
    endif()
  endwhile()
endfunction()

# taut_add_script_test(<folder> <name> LABELS <label>… ARGUMENTS <argument>… [COST <seconds>] [TIMEOUT <seconds>]
#   [SCRIPT <script>])
# registers tests/<folder>/<script>_test.py, of that name unless another is given, as the ctest entry <folder>.<name>.
function(taut_add_script_test folder name)
  cmake_parse_arguments(ARG "" "COST;TIMEOUT;SCRIPT" "LABELS;ARGUMENTS" ${ARGN})
  if(NOT ARG_SCRIPT)
    set(ARG_SCRIPT ${name})
  endif()
  add_test(NAME ${folder}.${name}
    COMMAND Python3::Interpreter -B ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/${ARG_SCRIPT}_test.py
      ${ARG_ARGUMENTS})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  set_tests_properties(${folder}.${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT})
  if(ARG_COST)
    set_tests_properties(${folder}.${name} PROPERTIES COST ${ARG_COST})
  endif()
endfunction()
