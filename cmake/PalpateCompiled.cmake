# palpate_add_compiled(<name> <source>...): a static library of src/<source>.cpp, what costs much to compile,
# for programs with PALPATE_COMPILED. All of a program has the same flags, as for any C++ templates: a folder
# with flags of its own, such as -march=native, makes a library of its own.
find_package(Threads)
set(PALPATE_COMPILED_SOURCES ${CMAKE_CURRENT_LIST_DIR}/../src)

function(palpate_add_compiled name)
  list(TRANSFORM ARGN PREPEND ${PALPATE_COMPILED_SOURCES}/ OUTPUT_VARIABLE sources)
  list(TRANSFORM sources APPEND .cpp)
  add_library(${name} STATIC EXCLUDE_FROM_ALL ${sources})
  target_compile_definitions(${name} PUBLIC PALPATE_COMPILED)
  target_link_libraries(${name} PUBLIC palpate)
  if(TARGET Threads::Threads)
    target_link_libraries(${name} PUBLIC Threads::Threads)
  else()
    target_compile_definitions(${name} PUBLIC PALPATE_NO_THREADS)
  endif()
endfunction()
