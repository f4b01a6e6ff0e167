# How a folder of pinjaw becomes a library, a program or a test. Each folder's CMakeLists.txt is one call.

find_program(PINJAW_CCACHE ccache)
if(PINJAW_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${PINJAW_CCACHE})
endif()

# The sources of a target are compiled eight at a time, as one: most of a source's time goes into the same headers.
# So a clean build and the tests fit a quarter of an hour on two cores; one edited source costs half a minute at worst.
# Private names are therefore unique in a target, not in a source. OFF compiles each source alone, as clang-tidy wants them.
# CMake leaves out by itself what has compile options of its own.
option(CMAKE_UNITY_BUILD "compile the sources of a target together" ON)
set(CMAKE_UNITY_BUILD_BATCH_SIZE 8)

add_library(pinjaw_flags INTERFACE)
target_include_directories(pinjaw_flags INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(pinjaw_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # GCC 12 sees uninitialised members in moved-from std::string and std::variant temporaries that are not
  target_compile_options(pinjaw_flags INTERFACE -Wno-maybe-uninitialized)
  if(CMAKE_UNITY_BUILD)
    # it is meant for headers; a source compiled with others looks like one
    target_compile_options(pinjaw_flags INTERFACE -Wno-subobject-linkage)
  endif()
endif()
if(PINJAW_SANITIZE)
  target_compile_options(pinjaw_flags INTERFACE
    -fsanitize=${PINJAW_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(pinjaw_flags INTERFACE -fsanitize=${PINJAW_SANITIZE})
endif()
if(PINJAW_COVERAGE)
  target_compile_options(pinjaw_flags INTERFACE --coverage -fno-inline)
  target_link_options(pinjaw_flags INTERFACE --coverage)
endif()
if(PINJAW_FUZZ)
  target_compile_options(pinjaw_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()

# pinjaw_library(NAME SOURCES ... [DEPENDS targets whose headers ours include] [USES third-party targets, private])
function(pinjaw_library name)
  cmake_parse_arguments(ARG "PORTABLE" "" "SOURCES;DEPENDS;USES" ${ARGN})
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES})
    target_link_libraries(${name} PUBLIC pinjaw_flags ${ARG_DEPENDS} PRIVATE ${ARG_USES})
    if(ARG_PORTABLE)
      target_compile_options(${name} PRIVATE -fno-exceptions -fno-rtti)
    endif()
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE pinjaw_flags ${ARG_DEPENDS} ${ARG_USES})
  endif()
endfunction()

# pinjaw_test(NAME SOURCES ... DEPENDS ... USES ... [LABELS ...] [TIMEOUT s])
# A test labelled `long` runs under ./dev test --all only, one labelled `nightly` there and under ./dev safety. GoogleTest's main; tests/support/places.hpp tells where the checkout and the programs are.
function(pinjaw_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;DEPENDS;USES;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  # A test's own code runs for seconds and is compiled for longer; what it calls stays as shipped.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  target_link_libraries(${name} PRIVATE pinjaw_flags ${ARG_DEPENDS} ${ARG_USES} pinjaw_test_places
    GTest::gmock GTest::gtest_main)
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS "${ARG_LABELS}")
endfunction()
