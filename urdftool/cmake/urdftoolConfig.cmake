# Functions of urdftool for packages that are built with CMake, with ament_cmake or without:
#
#   find_package(urdftool REQUIRED)
#   urdftool_expand(urdf/arm.urdf.xacro DESTINATION share/${PROJECT_NAME}/urdf)
#   urdftool_lint()
#
# https://urdftool.readthedocs.io/page/building.html describes them.

if(CMAKE_VERSION VERSION_LESS 3.20)
  set(urdftool_FOUND FALSE)
  set(urdftool_NOT_FOUND_MESSAGE
    "urdftool requires CMake 3.20 or later (DEPFILE of add_custom_command)")
  return()
endif()
cmake_policy(VERSION 3.20...3.31)

include("${CMAKE_CURRENT_LIST_DIR}/urdftoolProgram.cmake")
if(NOT URDFTOOL_EXECUTABLE)
  set(urdftool_FOUND FALSE)
  set(urdftool_NOT_FOUND_MESSAGE
    "program urdftool is not in PATH; activate its environment, or set URDFTOOL_EXECUTABLE")
  return()
endif()

# Stop for words of a call that its function does not know, and for keywords without a value.
function(_urdftool_check_call name)
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "${name}: unknown argument '${arg_UNPARSED_ARGUMENTS}'")
  endif()
  if(arg_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR "${name}: ${arg_KEYWORDS_MISSING_VALUES} requires a value")
  endif()
endfunction()

# Set `result` to the options of a command line for packages; folders are relative to the sources.
function(_urdftool_list_package_options result)
  set(words "")
  foreach(package IN LISTS arg_PACKAGES)
    if(NOT package MATCHES "^([^=]+)=(.+)$")
      message(FATAL_ERROR "urdftool: '${package}' of PACKAGES is not NAME=DIR")
    endif()
    set(name "${CMAKE_MATCH_1}")
    cmake_path(ABSOLUTE_PATH CMAKE_MATCH_2 BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}"
      OUTPUT_VARIABLE folder)
    list(APPEND words --package "${name}=${folder}")
  endforeach()
  foreach(folder IN LISTS arg_PACKAGE_PATHS)
    cmake_path(ABSOLUTE_PATH folder BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
    list(APPEND words --package-path "${folder}")
  endforeach()
  set(${result} "${words}" PARENT_SCOPE)
endfunction()

# Set `result` to the file that the expansion of `source` is written to, if the call names none: its
# place below the binary directory is that of the source below the source directory.
function(_urdftool_choose_output source result)
  string(REGEX REPLACE "(\\.urdf)?\\.xacro$" "" stem "${source}")
  cmake_path(IS_PREFIX CMAKE_CURRENT_SOURCE_DIR "${stem}" is_inside)
  if(is_inside)
    cmake_path(RELATIVE_PATH stem BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
  else()
    cmake_path(GET stem FILENAME stem)
  endif()
  set(${result} "${stem}.urdf" PARENT_SCOPE)
endfunction()

# Expand a xacro file during the build, again when a file that it reads has changed.
#
#   urdftool_expand(FILE [OUTPUT FILE] [ARGUMENTS name:=value...] [PACKAGES NAME=DIR...]
#                   [PACKAGE_PATHS DIR...] [DESTINATION DIR] [TARGET NAME])
#
# FILE         Relative to the current source directory.
# OUTPUT       URDF file, relative to the current binary directory. Default: the path of FILE, with
#              the ending .urdf.
# ARGUMENTS    Arguments of xacro.
# PACKAGES, PACKAGE_PATHS   Folders of ROS packages, as --package and --package-path.
# DESTINATION  Folder in which the URDF is installed. Default: it is not installed.
# TARGET       Name of the target, which is built with all. Default: from the output.
function(urdftool_expand file)
  cmake_parse_arguments(PARSE_ARGV 1 arg
    "" "OUTPUT;DESTINATION;TARGET" "ARGUMENTS;PACKAGES;PACKAGE_PATHS")
  _urdftool_check_call(urdftool_expand)
  cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE
    OUTPUT_VARIABLE source)
  if(NOT EXISTS "${source}" OR IS_DIRECTORY "${source}")
    message(FATAL_ERROR "urdftool_expand: file '${source}' does not exist")
  endif()
  if(NOT arg_OUTPUT)
    _urdftool_choose_output("${source}" arg_OUTPUT)
  endif()
  cmake_path(ABSOLUTE_PATH arg_OUTPUT BASE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}" NORMALIZE
    OUTPUT_VARIABLE output)
  if(output STREQUAL source)
    message(FATAL_ERROR "urdftool_expand: OUTPUT '${output}' is the file itself")
  endif()
  if(NOT arg_TARGET)
    string(MAKE_C_IDENTIFIER "${PROJECT_NAME}_${arg_OUTPUT}" arg_TARGET)
  endif()
  _urdftool_list_package_options(packages)
  add_custom_command(
    OUTPUT "${output}"
    COMMAND "${URDFTOOL_EXECUTABLE}" expand "${source}" ${arg_ARGUMENTS} ${packages}
            -o "${output}" --depfile "${output}.d"
    DEPENDS "${source}"
    DEPFILE "${output}.d" # its relative paths begin at the working directory, which is the default
    COMMENT "Expanding ${file}"
    VERBATIM)
  add_custom_target(${arg_TARGET} ALL DEPENDS "${output}")
  if(arg_DESTINATION)
    install(FILES "${output}" DESTINATION "${arg_DESTINATION}")
  endif()
endfunction()

# Add a test that checks robots with `urdftool lint`, and writes a JUnit file.
#
#   urdftool_lint([PATH...] [TESTNAME NAME] [ARGUMENTS name:=value...] [PACKAGES NAME=DIR...]
#                 [PACKAGE_PATHS DIR...] [OPTIONS WORD...] [TIMEOUT SECONDS])
#
# PATH      Files and folders, relative to the current source directory. Default: all robots of it.
# TESTNAME  Default: urdftool_lint.
# OPTIONS   More options of `urdftool lint`, such as --baseline FILE.
# TIMEOUT   Time limit [s]. Default: 300; chosen, as `lint` takes up to a minute for many robots.
#
# With ament_cmake_test, the test is one of ament_add_test, and its results are where other tests of
# ament have theirs. Otherwise it is one of add_test, which requires enable_testing() or
# include(CTest), and its results are in urdftool_lint.xml of the current binary directory.
function(urdftool_lint)
  cmake_parse_arguments(PARSE_ARGV 0 arg
    "" "TESTNAME;TIMEOUT" "ARGUMENTS;PACKAGES;PACKAGE_PATHS;OPTIONS")
  set(paths ${arg_UNPARSED_ARGUMENTS})
  unset(arg_UNPARSED_ARGUMENTS)
  _urdftool_check_call(urdftool_lint)
  if(DEFINED BUILD_TESTING AND NOT BUILD_TESTING)
    return()
  endif()
  if(NOT paths)
    set(paths .)
  endif()
  if(NOT arg_TESTNAME)
    set(arg_TESTNAME urdftool_lint)
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  _urdftool_list_package_options(packages)
  set(results "${CMAKE_CURRENT_BINARY_DIR}/${arg_TESTNAME}.xml")
  if(COMMAND ament_add_test)
    set(results "${AMENT_TEST_RESULTS_DIR}/${PROJECT_NAME}/${arg_TESTNAME}.xunit.xml")
  endif()
  set(words "${URDFTOOL_EXECUTABLE}" lint ${paths} ${arg_ARGUMENTS} ${packages} ${arg_OPTIONS}
    --junit "${results}")
  if(COMMAND ament_add_test)
    ament_add_test(${arg_TESTNAME}
      COMMAND ${words}
      RESULT_FILE "${results}"
      OUTPUT_FILE "${CMAKE_BINARY_DIR}/urdftool/${arg_TESTNAME}.txt"
      WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}"
      TIMEOUT ${arg_TIMEOUT})
  else()
    add_test(NAME ${arg_TESTNAME} COMMAND ${words}
      WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
    set_tests_properties(${arg_TESTNAME} PROPERTIES TIMEOUT ${arg_TIMEOUT})
  endif()
  set_tests_properties(${arg_TESTNAME} PROPERTIES LABELS "urdftool;linter")
endfunction()
