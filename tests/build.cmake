# Tests of how the library builds: each header alone, all of it in two objects, flags of the host, policies
# that must be refused, and the three ways of using it from another project. Label: build.

get_property(tests_of_code DIRECTORY PROPERTY TESTS)

file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/include
  ${PROJECT_SOURCE_DIR}/include/palpate/*.hpp)
list(SORT headers)
set(adapters ${headers})  # need another library
list(FILTER adapters INCLUDE REGEX "^palpate/adapters/")
list(FILTER headers EXCLUDE REGEX "^palpate/adapters/")
set(include_all "")
foreach(header IN LISTS headers)
  string(APPEND include_all "#include <${header}>\n")
endforeach()
set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
file(CONFIGURE OUTPUT ${generated}/all_headers.hpp CONTENT "#pragma once\n${include_all}" @ONLY)

# Each header alone, in two forms. The thorough form (tests/run --thorough) is the whole check: a file for
# each header, header-only, and against the compiled set-up without exceptions. The usual form has a file for
# each folder, with Eigen parsed already and without what only the set-up of a response field needs: a tenth
# of the time. Headers that include least come first there, so that few stand behind what they forgot. It
# cannot see an include that another header of the folder brought before, nor one of Eigen's. Force laws stay
# free of Eigen, which is most of a user's compile time: both forms check them without it.
set(adapter_libraries "")
foreach(adapter IN LISTS adapters)
  get_filename_component(name ${adapter} NAME_WE)
  if(TARGET palpate_adapter_${name})
    list(APPEND headers ${adapter})
    list(APPEND adapter_libraries palpate_adapter_${name})
  endif()
endforeach()
set(without_eigen "#ifdef EIGEN_WORLD_VERSION\n#error force laws do not include Eigen\n#endif\n")
set(sources_alone "")
set(by_includes "")
foreach(header IN LISTS headers)
  string(REGEX REPLACE "[/.]" "_" name ${header})
  set(text "#include <${header}>\n")
  if(header MATCHES "^palpate/law/force/")
    string(APPEND text "${without_eigen}")
  endif()
  file(CONFIGURE OUTPUT ${generated}/${name}.cpp CONTENT "${text}" @ONLY)
  list(APPEND sources_alone ${generated}/${name}.cpp)
  file(STRINGS ${PROJECT_SOURCE_DIR}/include/${header} includes REGEX "^#include <palpate/")
  list(LENGTH includes count)
  list(APPEND by_includes "${count}:${header}")
endforeach()
list(SORT by_includes COMPARE NATURAL)
set(folders "")
foreach(entry IN LISTS by_includes)
  string(REGEX REPLACE "^[0-9]+:" "" header ${entry})
  get_filename_component(folder ${header} DIRECTORY)
  string(REPLACE "/" "_" folder ${folder})
  list(APPEND folders ${folder})
  string(APPEND text_of_${folder} "#include <${header}>\n")
endforeach()
list(REMOVE_DUPLICATES folders)
string(APPEND text_of_palpate_law_force "${without_eigen}")
set(sources_by_folder "")
foreach(folder IN LISTS folders)
  file(CONFIGURE OUTPUT ${generated}/folder_${folder}.cpp CONTENT "${text_of_${folder}}" @ONLY)
  list(APPEND sources_by_folder ${generated}/folder_${folder}.cpp)
endforeach()
set_source_files_properties(${generated}/folder_palpate_law_force.cpp PROPERTIES SKIP_PRECOMPILE_HEADERS ON)

function(palpate_headers_alone target sources)  # and flags
  add_library(${target} OBJECT ${${sources}})
  palpate_own_target(${target})
  # Nothing links these objects: templates are checked, and no code is made of them.
  target_compile_options(${target} PRIVATE -O0 -fno-implicit-templates -fno-implicit-inline-templates ${ARGN})
  target_link_libraries(${target} PRIVATE ${adapter_libraries})
endfunction()
# One compiler is enough: an include that is missing is missing for all.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  palpate_headers_alone(palpate_test_headers sources_by_folder -DPALPATE_COMPILED)
  target_precompile_headers(palpate_test_headers PRIVATE <Eigen/Core> <Eigen/Geometry>)
  palpate_headers_alone(palpate_test_headers_thorough sources_alone)
  palpate_headers_alone(palpate_test_headers_noexcept sources_alone -fno-exceptions -fno-rtti -DPALPATE_COMPILED)
  add_custom_target(palpate_test_thorough DEPENDS palpate_test_headers_thorough palpate_test_headers_noexcept)
  set_target_properties(palpate_test_headers_thorough palpate_test_headers_noexcept
    PROPERTIES EXCLUDE_FROM_ALL ON)
endif()

# An engine: no exceptions, no RTTI, fast-math, and a palpate_config.hpp of its own.
set(host_flags -fno-exceptions -fno-rtti -ffast-math)
add_executable(palpate_test_host host/main.cpp)
palpate_own_target(palpate_test_host)
target_include_directories(palpate_test_host PRIVATE host/config)
target_compile_options(palpate_test_host PRIVATE ${host_flags})
add_test(NAME host COMMAND palpate_test_host)

# Two objects of one program that both set up and use a response field: each with every header, header-only,
# as that engine's; and the field alone against the compiled set-up. What matters is that there are two: the
# second is a copy of the first, and costs nothing to compile.
function(palpate_two_objects program source)  # and what they link
  add_library(palpate_test_${program}_object OBJECT odr/${source}.cpp)
  set(second ${CMAKE_CURRENT_BINARY_DIR}/${program}_second${CMAKE_CXX_OUTPUT_EXTENSION})
  add_custom_command(OUTPUT ${second} DEPENDS palpate_test_${program}_object
    $<TARGET_OBJECTS:palpate_test_${program}_object>
    COMMAND ${CMAKE_COMMAND} -E copy $<TARGET_OBJECTS:palpate_test_${program}_object> ${second})
  set_source_files_properties(${second} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  add_executable(palpate_test_${program} odr/main.cpp ${second}
    $<TARGET_OBJECTS:palpate_test_${program}_object>)
  target_link_libraries(palpate_test_${program} PRIVATE ${ARGN})
  target_link_libraries(palpate_test_${program}_object PRIVATE ${ARGN})
  foreach(target palpate_test_${program} palpate_test_${program}_object)
    palpate_own_target(${target})
  endforeach()
  target_include_directories(palpate_test_${program}_object PRIVATE ${generated} ${CMAKE_CURRENT_SOURCE_DIR})
  target_compile_options(palpate_test_${program}_object PRIVATE -O0)
  add_test(NAME ${program} COMMAND palpate_test_${program})
endfunction()
palpate_two_objects(odr all Threads::Threads)
target_sources(palpate_test_odr PRIVATE host/hooks.cpp)
target_include_directories(palpate_test_odr_object PRIVATE host/config)
target_compile_options(palpate_test_odr_object PRIVATE ${host_flags})
palpate_two_objects(odr_compiled field palpate::compiled_response)

# Without exceptions and without a handler: the message on stderr, then abort().
add_executable(palpate_test_host_default host/default_handler.cpp)
palpate_own_target(palpate_test_host_default)
target_compile_options(palpate_test_host_default PRIVATE -fno-exceptions -fno-rtti)
add_test(NAME host_default COMMAND palpate_test_host_default)
set_tests_properties(host_default PROPERTIES
  PASS_REGULAR_EXPRESSION "palpate: Spring: stiffness \\[N/m\\] must be > 0, got -3")

# What crosses the interface has the same size and alignment whatever the host's vector flags.
include(CheckCXXCompilerFlag)
check_cxx_compiler_flag(-mavx512f PALPATE_HAS_AVX_FLAGS)
if(PALPATE_HAS_AVX_FLAGS)
  add_library(palpate_test_sizes_plain OBJECT sizes/sizes.cpp)
  target_compile_definitions(palpate_test_sizes_plain PRIVATE PALPATE_TEST_SIZES=sizes_plain)
  add_library(palpate_test_sizes_avx OBJECT sizes/sizes.cpp)
  target_compile_definitions(palpate_test_sizes_avx PRIVATE PALPATE_TEST_SIZES=sizes_avx)
  target_compile_options(palpate_test_sizes_avx PRIVATE -mavx)
  add_library(palpate_test_sizes_avx512 OBJECT sizes/sizes.cpp)
  target_compile_definitions(palpate_test_sizes_avx512 PRIVATE PALPATE_TEST_SIZES=sizes_avx512)
  target_compile_options(palpate_test_sizes_avx512 PRIVATE -mavx512f -mfma)
  add_executable(palpate_test_sizes sizes/main.cpp)
  foreach(target palpate_test_sizes_plain palpate_test_sizes_avx palpate_test_sizes_avx512 palpate_test_sizes)
    palpate_own_target(${target})
  endforeach()
  target_link_libraries(palpate_test_sizes
    PRIVATE palpate_test_sizes_plain palpate_test_sizes_avx palpate_test_sizes_avx512)
  add_test(NAME sizes COMMAND palpate_test_sizes)
endif()

# Policies that must be refused, with a message that names what is missing.
get_target_property(eigen_include Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
set(plain_flags -std=c++20 -I${PROJECT_SOURCE_DIR}/include -isystem ${eigen_include})
if(CMAKE_CXX_COMPILER_ID MATCHES "^(GNU|Clang)$")
  file(GLOB sources CONFIGURE_DEPENDS compile/*.cpp)
  foreach(source IN LISTS sources)
    get_filename_component(name ${source} NAME_WE)
    add_test(NAME compile_${name} COMMAND ${CMAKE_COMMAND} -DCOMPILER=${CMAKE_CXX_COMPILER}
      -DID=${CMAKE_CXX_COMPILER_ID} "-DFLAGS=${plain_flags}" -DSOURCE=${source}
      -P ${CMAKE_CURRENT_SOURCE_DIR}/compile/check.cmake)
  endforeach()
endif()

# The three ways of using palpate from another project.
set(consumer ${CMAKE_CURRENT_BINARY_DIR}/consumer)
add_test(NAME consumer_plain COMMAND ${CMAKE_CXX_COMPILER} ${plain_flags}
  ${CMAKE_CURRENT_SOURCE_DIR}/consumer/main.cpp -o ${consumer}_plain)
add_test(NAME consumer_plain_run COMMAND ${consumer}_plain)
set_tests_properties(consumer_plain PROPERTIES FIXTURES_SETUP consumer_plain)
set_tests_properties(consumer_plain_run PROPERTIES FIXTURES_REQUIRED consumer_plain)

function(palpate_consumer_test way)
  add_test(NAME consumer_${way} COMMAND ${CMAKE_CTEST_COMMAND}
    --build-and-test ${CMAKE_CURRENT_SOURCE_DIR}/consumer/${way} ${consumer}/${way}
    --build-generator ${CMAKE_GENERATOR}
    --build-options -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -DCMAKE_BUILD_TYPE=Release ${ARGN}
    --test-command consumer)
endfunction()
palpate_consumer_test(add_subdirectory -DPALPATE_SOURCE_DIR=${PROJECT_SOURCE_DIR})
if(PALPATE_INSTALL)
  add_test(NAME install COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --prefix ${consumer}/prefix)
  palpate_consumer_test(find_package
    -DCMAKE_PREFIX_PATH=${consumer}/prefix -DPALPATE_VERSION=${PROJECT_VERSION})
  set_tests_properties(install PROPERTIES FIXTURES_SETUP install)
  set_tests_properties(consumer_find_package PROPERTIES FIXTURES_REQUIRED install)
endif()

# The rules of the house that a script can check, and the script itself.
if(UNIX)
  add_test(NAME house COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/check_house.sh ${PROJECT_SOURCE_DIR})
  add_test(NAME readme COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/check_readme.sh ${PROJECT_SOURCE_DIR})
  add_test(NAME docs COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/check_docs.sh ${PROJECT_SOURCE_DIR})
  foreach(check budgets docs house)
    add_test(NAME ${check}_refuses
      COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/check_${check}_test.sh ${CMAKE_CURRENT_BINARY_DIR}/${check})
  endforeach()
endif()

get_property(tests DIRECTORY PROPERTY TESTS)
list(REMOVE_ITEM tests ${tests_of_code})
set_tests_properties(${tests} PROPERTIES LABELS build)
