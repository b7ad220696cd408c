# What palpate's own tests, benchmarks and examples are compiled with. All of it is PRIVATE: whoever uses
# palpate gets an include directory, C++20 and Eigen, and no flag of ours. Warnings become errors by
# CMAKE_COMPILE_WARNING_AS_ERROR, which the presets set.

set(PALPATE_SANITIZE "" CACHE STRING "Sanitizers for palpate's own targets, as in -fsanitize=")

function(palpate_own_target target)
  target_link_libraries(${target} PRIVATE palpate::palpate)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  if(MSVC)
    target_compile_options(${target} PRIVATE /W4 /permissive-)
  else()
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # gcc looks for garbage from 128 MB [kB here] on, and finds little: a tenth of the time for a tenth of the
    # memory.
    target_compile_options(${target} PRIVATE --param=ggc-min-heapsize=300000)
  endif()
  if(PALPATE_SANITIZE)
    target_compile_options(${target} PRIVATE
      -fsanitize=${PALPATE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PRIVATE -fsanitize=${PALPATE_SANITIZE})
  endif()
endfunction()
