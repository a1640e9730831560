# Find the program urdftool: that of the environment in which this file is, before another of PATH.
# The file is in PREFIX/share/urdftool/cmake and PREFIX/lib/pythonX.Y/site-packages/urdftool/cmake,
# or PREFIX/Lib/site-packages/urdftool/cmake on Windows.

find_program(URDFTOOL_EXECUTABLE urdftool
  HINTS
    "${CMAKE_CURRENT_LIST_DIR}/../../../bin"
    "${CMAKE_CURRENT_LIST_DIR}/../../../Scripts"
    "${CMAKE_CURRENT_LIST_DIR}/../../../../../bin"
    "${CMAKE_CURRENT_LIST_DIR}/../../../../Scripts"
  DOC "The program urdftool")
