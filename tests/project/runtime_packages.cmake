# The run-time packages of docs/cluster.md and of tools/apptainer.def are the
# same.
#
# cmake -D ROOT=<source folder> -P runtime_packages.cmake
cmake_minimum_required(VERSION 3.18)
foreach(name docs/cluster.md tools/apptainer.def)
  file(READ "${ROOT}/${name}" text)
  string(REGEX MATCH "libopenblas0-pthread[a-z0-9.+ \\\n-]*" block "${text}")
  string(REGEX MATCHALL "lib[a-z0-9.+-]+" packages "${block}")
  list(LENGTH packages count)
  if(count LESS 10)
    message(FATAL_ERROR "${name}: expected a list of run-time packages")
  endif()
  if(NOT DEFINED expected)
    set(expected "${packages}")
  elseif(NOT packages STREQUAL expected)
    message(FATAL_ERROR "${name}: other packages than docs/cluster.md has")
  endif()
endforeach()
