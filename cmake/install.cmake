# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# What an installation holds beside the programs, libraries and headers, which install themselves where they are
# added, and the Debian packages that CPack makes of it. docs/install.md tells users what lies where.
#
# Components: `programs` and all they need, `development` for who links the libraries; where Debian wants a file
# elsewhere than other systems do, `elsewhere` has it for those and `debian` for the package.

set(DOORFORGE_DATADIR ${CMAKE_INSTALL_DATADIR}/doorforge)
set(DOORFORGE_PYTHONDIR lib/python3/dist-packages CACHE STRING
    "where the Python package is installed; relative to the prefix")

foreach(folder CMAKE_INSTALL_BINDIR CMAKE_INSTALL_DATADIR)
  if(IS_ABSOLUTE "${${folder}}")
    message(FATAL_ERROR "${folder} is ${${folder}}; it must be relative to the prefix, which then can be moved")
  endif()
endforeach()

set(DOORFORGE_MAINTAINER "The doorforge authors <authors@doorforge.invalid>" CACHE STRING
    "who answers for the Debian packages: NAME <ADDRESS>")

# Programs find their data from where they are themselves, so the build tree is laid out as an installation is.
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_BINDIR})
file(RELATIVE_PATH DOORFORGE_DATA_FROM_PROGRAMS
     ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_DATADIR}/doorforge)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_DATADIR})
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/data ${CMAKE_BINARY_DIR}/${DOORFORGE_DATADIR} SYMBOLIC)
# the same for what a program runs of the Python package
file(RELATIVE_PATH DOORFORGE_PYTHON_FROM_PROGRAMS
     ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_PREFIX}/${DOORFORGE_PYTHONDIR})
get_filename_component(python_parent ${CMAKE_BINARY_DIR}/${DOORFORGE_PYTHONDIR} DIRECTORY)
file(MAKE_DIRECTORY ${python_parent})
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/python ${CMAKE_BINARY_DIR}/${DOORFORGE_PYTHONDIR} SYMBOLIC)

# Man pages and completion are made of what the programs say of their own options, so nobody keeps a second list.
# To be called when all programs are known.
function(doorforge_describe_commands)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  get_property(programs GLOBAL PROPERTY DOORFORGE_PROGRAMS)
  file(GLOB scripts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scripts/commands/*.py)
  set(described ${CMAKE_BINARY_DIR}/commands)
  add_custom_command(
    OUTPUT ${described}/written
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${described}
    COMMAND Python3::Interpreter -B ${PROJECT_SOURCE_DIR}/scripts/commands/write_all.py
            $<TARGET_FILE_DIR:doorforge> ${PROJECT_VERSION} ${described} ${programs}
    COMMAND ${CMAKE_COMMAND} -E touch ${described}/written
    DEPENDS ${programs} ${scripts}
    COMMENT "Writing man pages and completion of the programs' options" VERBATIM)
  add_custom_target(doorforge_commands ALL DEPENDS ${described}/written)

  # the documents, these pages among them, as a site in build/.../site; see docs/site.md
  add_custom_target(site
    COMMAND Python3::Interpreter -B ${PROJECT_SOURCE_DIR}/scripts/site/build_site.py
            ${CMAKE_BINARY_DIR} ${CMAKE_BINARY_DIR}/site
    DEPENDS ${programs}
    COMMENT "Building the site of the documents" VERBATIM)

  install(DIRECTORY ${described}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT programs)
  install(FILES ${described}/bash/doorforge
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT programs)
  install(FILES ${described}/fish/doorforge.fish
          DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT programs)
  install(FILES ${described}/zsh/_doorforge
          DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT elsewhere)
  install(FILES ${described}/zsh/_doorforge
          DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT debian EXCLUDE_FROM_ALL)
endfunction()

function(doorforge_install_files)
  # a link to what the next line installs, for the build tree
  install(DIRECTORY data/ DESTINATION ${DOORFORGE_DATADIR} COMPONENT programs PATTERN schemas EXCLUDE)
  install(DIRECTORY schemas/json/ DESTINATION ${DOORFORGE_DATADIR}/schemas COMPONENT programs)
  install(DIRECTORY python/ DESTINATION ${DOORFORGE_PYTHONDIR} COMPONENT programs
          FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed" PATTERN src EXCLUDE)
  install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs)
  install(FILES NOTICE CHANGELOG.md cmake/package/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT elsewhere)
endfunction()

# Seconds since 1970 that stand for "now" in packages, so that the same sources make the same bytes: SOURCE_DATE_EPOCH
# (https://reproducible-builds.org/specs/source-date-epoch), else the commit's date, else a day of the release's year.
function(doorforge_source_date result)
  set(date "$ENV{SOURCE_DATE_EPOCH}")
  if(NOT date)
    execute_process(COMMAND git log -1 --format=%ct WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                    OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE ignored)
  endif()
  if(NOT date MATCHES "^[0-9]+$")
    set(date 1767225600)  # 2026-01-01
  endif()
  set(${result} ${date} PARENT_SCOPE)
endfunction()

# What Debian wants of each package beside its files.
function(doorforge_install_debian_documents)
  set(ENV{SOURCE_DATE_EPOCH} ${DOORFORGE_SOURCE_DATE})  # the next line goes by it
  string(TIMESTAMP DOORFORGE_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
  set(folder ${CMAKE_BINARY_DIR}/debian)
  configure_file(cmake/package/changelog.in ${folder}/changelog @ONLY)
  # CMake's own archives hold the time at which they were made
  execute_process(COMMAND gzip -9nc ${folder}/changelog OUTPUT_FILE ${folder}/changelog.gz COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${folder}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/doorforge
          COMPONENT debian EXCLUDE_FROM_ALL)
  install(FILES ${folder}/changelog.gz cmake/package/copyright
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libdoorforge-dev COMPONENT debian-development EXCLUDE_FROM_ALL)
endfunction()

# The packages of packages.txt that a consumer of the libraries needs: what [build] names -dev, or has no other part.
function(doorforge_development_packages result)
  file(STRINGS packages.txt lines)
  set(inside FALSE)
  set(packages "")
  foreach(line IN LISTS lines)
    if(line MATCHES "^\\[")
      string(COMPARE EQUAL "${line}" "[build]" inside)
    elseif(inside AND line MATCHES "-dev$")
      list(APPEND packages ${line})
    endif()
  endforeach()
  list(JOIN packages ", " packages)
  set(${result} ${packages} PARENT_SCOPE)
endfunction()

# cpack -G DEB, in the build folder: doorforge_*.deb, which users install, and libdoorforge-dev_*.deb.
# The same sources make the same bytes under the same umask (scripts/compare_packages.sh): times are the sources'.
function(doorforge_package)
  doorforge_source_date(DOORFORGE_SOURCE_DATE)
  doorforge_install_debian_documents()
  configure_file(cmake/package/source_date.cmake.in ${CMAKE_BINARY_DIR}/debian/source_date.cmake @ONLY)
  set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_BINARY_DIR}/debian/source_date.cmake)
  set(CPACK_PACKAGE_NAME doorforge)
  set(CPACK_PACKAGE_VENDOR "The doorforge authors")
  set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Door assets and door-opening data for robot learning")
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_STRIP_FILES ON)
  set(CPACK_VERBATIM_VARIABLES ON)

  set(CPACK_DEB_COMPONENT_INSTALL ON)
  set(CPACK_COMPONENTS_ALL programs debian development debian-development)
  set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
  set(CPACK_COMPONENT_PROGRAMS_GROUP programs)
  set(CPACK_COMPONENT_DEBIAN_GROUP programs)
  set(CPACK_COMPONENT_DEVELOPMENT_GROUP development)
  set(CPACK_COMPONENT_DEBIAN-DEVELOPMENT_GROUP development)

  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${DOORFORGE_MAINTAINER})
  set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
  set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME doorforge)
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
  # The packages of libraries are found when all is packed. libtorch is content with any BLAS, and trains ten times slower
  # with the one that Debian would take. What else programs call, bash and one another, is always there.
  set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package/library_packages.cmake)
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS libopenblas0-openmp)
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "python3, python3-numpy")
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "slurm-client, python3-h5py")
  set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION [[
Composes doors whose latch must be released through the handle, lets a mobile
robot arm open them in simulation, sees them through an occluded depth camera,
collects data sets, and trains and evaluates policies that open them.
.
This package holds the programs, the catalogue of parts, the built-in robot,
trained policies, the JSON Schemas of the records, and the Python package
doorforge.]])

  doorforge_development_packages(packages)
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libdoorforge-dev)
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "doorforge (= ${PROJECT_VERSION}), ${packages}")
  set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION [[
Static libraries, headers and the CMake package of doorforge, for programs that
compose doors, simulate them, read its data sets or evaluate policies of their
own.]])
  include(CPack)
endfunction()
