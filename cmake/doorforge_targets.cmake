# The one table of allowed dependencies between rooms. A target may link only the rooms listed
# here; tests/architecture/layering_test.py checks the same table against #include lines.
set(DOORFORGE_ALLOWED_core "")
set(DOORFORGE_ALLOWED_cli core)
set(DOORFORGE_ALLOWED_pipeline core)
set(DOORFORGE_ALLOWED_schemas core)
set(DOORFORGE_ALLOWED_mesh core)
set(DOORFORGE_ALLOWED_solids core mesh)
set(DOORFORGE_ALLOWED_parts core schemas mesh)
set(DOORFORGE_ALLOWED_catalogue core schemas mesh solids parts)
set(DOORFORGE_ALLOWED_importers core schemas mesh solids parts)
set(DOORFORGE_ALLOWED_exporters core schemas)
set(DOORFORGE_ALLOWED_compose core schemas mesh parts exporters)
set(DOORFORGE_ALLOWED_validate core schemas mesh parts exporters)
set(DOORFORGE_ALLOWED_foreign core schemas mesh parts validate)
set(DOORFORGE_ALLOWED_authoring core schemas mesh catalogue importers exporters compose)
set(DOORFORGE_ALLOWED_conformance core schemas exporters)
set(DOORFORGE_ALLOWED_openable core schemas mesh validate physics rollout)
set(DOORFORGE_ALLOWED_preview core schemas sensor)
set(DOORFORGE_ALLOWED_view core schemas validate foreign physics sensor rollout)
set(DOORFORGE_ALLOWED_composer core schemas mesh catalogue compose authoring exporters validate openable view)
set(DOORFORGE_ALLOWED_physics core schemas)
set(DOORFORGE_ALLOWED_robot_meshes core schemas mesh physics)
set(DOORFORGE_ALLOWED_sensor core schemas)
set(DOORFORGE_ALLOWED_rollout core schemas physics sensor)
set(DOORFORGE_ALLOWED_pictures core schemas physics sensor rollout)
set(DOORFORGE_ALLOWED_networks core schemas)
set(DOORFORGE_ALLOWED_policy core schemas networks)
set(DOORFORGE_ALLOWED_registry core cli schemas physics sensor rollout pictures networks policy)
set(DOORFORGE_ALLOWED_dataset core schemas)
set(DOORFORGE_ALLOWED_collect core schemas physics sensor rollout pictures networks policy registry dataset)
set(DOORFORGE_ALLOWED_training core schemas networks policy)
set(DOORFORGE_ALLOWED_reinforce core schemas physics sensor rollout networks policy training)
set(DOORFORGE_ALLOWED_report core schemas)
set(DOORFORGE_ALLOWED_evaluate core schemas physics sensor rollout networks policy registry report)
set(DOORFORGE_ALLOWED_deploy core schemas physics sensor rollout networks policy)
set(DOORFORGE_ALLOWED_remote core cli schemas registry)
set(DOORFORGE_ALLOWED_benchmark core pipeline schemas report)
set(DOORFORGE_ALLOWED_verbs core cli pipeline schemas registry report benchmark evaluate remote)

# Contraction off: an asset, an episode and a cloud must not depend on whether the compiler fused
# a multiply with an add.
set(DOORFORGE_COMPILE_OPTIONS -Wall -Wextra -Wshadow -Wconversion -ffp-contract=off)

# What strangers' files reach is compiled with the checks that the library and the compiler offer: indices
# of the standard library's containers, sizes of buffers, the stack. docs/performance.md has their cost.
option(DOORFORGE_HARDENED "check indices, buffers and the stack at run time" ON)
if(DOORFORGE_HARDENED AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  list(APPEND DOORFORGE_COMPILE_OPTIONS -D_GLIBCXX_ASSERTIONS -fstack-protector-strong
       "$<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=3>")
  # where they cost much and everything that is reached was checked before
  set(DOORFORGE_UNCHECKED_OPTIONS -U_GLIBCXX_ASSERTIONS -fno-stack-protector)
endif()

# Rooms in whose own code nobody waits: they parse, describe, draw up and pass on, or run once a part. A release build
# optimises them lightly, which takes the compiler two thirds of the time; what runs in every step of an episode or a
# training, and what reads and writes meshes and shards, lies in the others. Programs, tests and the Python package are
# as these rooms are. Their bytes are those of -O3: floating point is the standard's at every level.
set(DOORFORGE_LIGHT_ROOMS
    cli pipeline catalogue importers exporters compose authoring validate foreign openable conformance preview view
    composer robot_meshes registry dataset collect report evaluate deploy remote verbs)
set(DOORFORGE_LIGHT_OPTIONS $<$<CONFIG:Release>:-O1>$<$<CONFIG:RelWithDebInfo>:-Og>)

# For a build from nothing, as ./quickstart.sh and ./test.sh do: what nearly every source includes is
# parsed once, the sources of a room are compiled together, and no line numbers are written. Not done where a
# launcher such as ccache is set: it keeps nothing that was made with precompiled headers, and after
# an edit more is compiled again. A source is then no longer seen to include what it uses, so clang-tidy
# and builds with ccache look at each by itself.
option(DOORFORGE_BUILD_FROM_NOTHING "arrange the build for speed from nothing" OFF)
set(DOORFORGE_PRECOMPILED_HEADERS
    <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <map> <memory> <numbers>
    <optional> <set> <span> <sstream> <string> <string_view> <utility> <vector>
    <Eigen/Geometry> <nlohmann/json.hpp>)

# doorforge_build_from_nothing(<target> <owner> [<further headers>])
# The target takes the headers that the owner precompiles, which needs the same options of the
# compiler; a target that owns them precompiles them for itself, and one without an owner, "", goes without.
# Its sources are compiled together, so names in their unnamed namespaces must differ.
function(doorforge_build_from_nothing target owner)
  if(NOT DOORFORGE_BUILD_FROM_NOTHING OR CMAKE_CXX_COMPILER_LAUNCHER)
    return()
  endif()
  set_target_properties(${target} PROPERTIES
    UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
  # the first is about headers, which sources look like here; the compiler finds the others in strings of
  # the standard library where more is inlined
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage;-Wno-stringop-overflow;-Wno-array-bounds>)
  # only debuggers and sanitizers ask for line numbers
  if(NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    target_compile_options(${target} PRIVATE -g0)
  endif()
  if(NOT owner)
    return()
  endif()
  if(target STREQUAL owner)
    target_precompile_headers(${target} PRIVATE ${DOORFORGE_PRECOMPILED_HEADERS} ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()

# doorforge_keep_apart(<room> <sources>)
# These sources of a room become an object of their own, or one each where each is named alone, apart from the object that
# the others become: who needs a convex hull alone, such as the Python package, gets no CGAL (GPL) with it.
function(doorforge_keep_apart room)
  get_target_property(sources doorforge_${room} SOURCES)
  get_target_property(grouped doorforge_${room} UNITY_BUILD_MODE)
  if(NOT grouped STREQUAL "GROUP")
    set_target_properties(doorforge_${room} PROPERTIES UNITY_BUILD_MODE GROUP)
    set_source_files_properties(${sources} PROPERTIES UNITY_GROUP others)
  endif()
  list(GET ARGN 0 first)
  get_filename_component(name ${first} NAME_WE)
  set_source_files_properties(${ARGN} PROPERTIES UNITY_GROUP ${name})
endfunction()

# doorforge_add_library(<room> HEADERS <public .h> SOURCES <private .h .cpp> [INTERNAL <.h>] [ROOMS <rooms>]
#                     [PUBLIC <targets>] [PRIVATE <targets>] [PACKAGES <find_package names>])
# Creates doorforge::<room>. Public headers live in include/doorforge/<room>/, all else in src/.
# INTERNAL headers lie beside the public ones, for the rooms above this one; they are not installed.
# PACKAGES names what a consumer of this room must find; rooms pass theirs on to those above.
function(doorforge_add_library room)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "HEADERS;INTERNAL;SOURCES;ROOMS;PUBLIC;PRIVATE;PACKAGES")
  set(packages ${arg_PACKAGES})
  foreach(dependency IN LISTS arg_ROOMS)
    if(NOT dependency IN_LIST DOORFORGE_ALLOWED_${room})
      message(FATAL_ERROR "${room} may not depend on ${dependency}; allowed: ${DOORFORGE_ALLOWED_${room}}")
    endif()
    list(APPEND packages ${DOORFORGE_PACKAGES_${dependency}})
  endforeach()
  list(REMOVE_DUPLICATES packages)
  set(DOORFORGE_PACKAGES_${room} ${packages} CACHE INTERNAL "packages a consumer of ${room} needs")
  set_property(GLOBAL APPEND PROPERTY DOORFORGE_COMPONENTS ${room})

  set(target doorforge_${room})
  add_library(${target} ${arg_SOURCES} ${arg_INTERNAL})
  add_library(doorforge::${room} ALIAS ${target})
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS include FILES ${arg_HEADERS})
  list(TRANSFORM arg_ROOMS PREPEND doorforge::)
  target_link_libraries(${target} PUBLIC ${arg_ROOMS} ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE ${DOORFORGE_COMPILE_OPTIONS})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${room} CXX_EXTENSIONS OFF)
  # CGAL and libtorch come with options of their own, and what libtorch needs is one object
  if(room STREQUAL training)
    doorforge_build_from_nothing(${target} "")
  elseif(room STREQUAL mesh)
    doorforge_build_from_nothing(${target} ${target})
  elseif(room IN_LIST DOORFORGE_LIGHT_ROOMS)
    target_compile_options(${target} PRIVATE ${DOORFORGE_LIGHT_OPTIONS})
    doorforge_build_from_nothing(${target} doorforge_cli)
  else()
    doorforge_build_from_nothing(${target} doorforge_core)
  endif()
  install(TARGETS ${target} EXPORT doorforgeTargets ARCHIVE COMPONENT development
          FILE_SET HEADERS COMPONENT development)
endfunction()

# doorforge_add_program(<name> SOURCES <.cpp> ROOMS <rooms> [PRIVATE <targets>])
# Creates bin/<name>. A program may link several rooms; rooms may not link programs.
function(doorforge_add_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;ROOMS;PRIVATE")
  add_executable(${name} ${arg_SOURCES})
  list(TRANSFORM arg_ROOMS PREPEND doorforge::)
  target_link_libraries(${name} PRIVATE ${arg_ROOMS} ${arg_PRIVATE})
  target_compile_options(${name} PRIVATE ${DOORFORGE_COMPILE_OPTIONS} ${DOORFORGE_LIGHT_OPTIONS})
  set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF)
  doorforge_build_from_nothing(${name} doorforge <CLI/CLI.hpp>)
  install(TARGETS ${name} COMPONENT programs)
  set_property(GLOBAL APPEND PROPERTY DOORFORGE_PROGRAMS ${name})
endfunction()

function(doorforge_install_package)
  include(CMakePackageConfigHelpers)
  set(destination ${CMAKE_INSTALL_LIBDIR}/cmake/doorforge)
  get_property(components GLOBAL PROPERTY DOORFORGE_COMPONENTS)
  set(DOORFORGE_PACKAGE_TABLE "")
  foreach(room IN LISTS components)
    string(APPEND DOORFORGE_PACKAGE_TABLE "set(doorforge_packages_${room} ${DOORFORGE_PACKAGES_${room}})\n")
  endforeach()
  install(EXPORT doorforgeTargets NAMESPACE doorforge:: DESTINATION ${destination} COMPONENT development)
  configure_package_config_file(cmake/doorforgeConfig.cmake.in doorforgeConfig.cmake
                                INSTALL_DESTINATION ${destination})
  write_basic_package_version_file(doorforgeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/doorforgeConfig.cmake
                ${CMAKE_CURRENT_BINARY_DIR}/doorforgeConfigVersion.cmake
          DESTINATION ${destination} COMPONENT development)
endfunction()
