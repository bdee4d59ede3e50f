# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# Read by cpack when all files of the packages lie in their folders: the package of programs depends on the packages that
# hold the libraries of its programs. CPACK_DEBIAN_PACKAGE_SHLIBDEPS says the same, but starts two programs for every file
# to learn which are programs, which takes longer than all else of packing.
set(folder "${CPACK_TEMPORARY_DIRECTORY}/programs")
if(NOT EXISTS "${folder}/usr/bin")
  return()
endif()
file(GLOB_RECURSE files LIST_DIRECTORIES false RELATIVE "${folder}" "${folder}/*")
set(programs "")
foreach(path IN LISTS files)
  file(READ "${folder}/${path}" magic LIMIT 4 HEX)
  if(magic STREQUAL "7f454c46")  # ELF
    list(APPEND programs "./${path}")
  endif()
endforeach()

# dpkg-shlibdeps wants to be where a Debian source package is
file(MAKE_DIRECTORY "${folder}/debian" "${folder}/DEBIAN")
file(WRITE "${folder}/debian/control" "")
execute_process(COMMAND dpkg-shlibdeps --ignore-missing-info -O ${programs}
                WORKING_DIRECTORY "${folder}" OUTPUT_VARIABLE found ERROR_VARIABLE problem RESULT_VARIABLE failed)
file(REMOVE_RECURSE "${folder}/debian" "${folder}/DEBIAN")
if(failed OR NOT found MATCHES "shlibs:Depends=([^\n]+)")
  message(FATAL_ERROR "dpkg-shlibdeps finds no packages of libraries: ${failed} ${problem}")
endif()
string(APPEND CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS ", ${CMAKE_MATCH_1}")
