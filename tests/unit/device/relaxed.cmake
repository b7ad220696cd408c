# The thread sanitizer must see a hand-over without ordering: the test in handover_test.cpp against a copy of
# the two headers in which every memory order is relaxed. Each class must be reported as a data race.

set(relaxed ${CMAKE_CURRENT_BINARY_DIR}/relaxed)
foreach(header triple_buffer spsc_ring)
  set(source ${PROJECT_SOURCE_DIR}/include/palpate/device/${header}.hpp)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
  file(READ ${source} text)
  string(REGEX REPLACE "memory_order_(acq_rel|acquire|release)" "memory_order_relaxed" text "${text}")
  file(CONFIGURE OUTPUT ${relaxed}/palpate/device/${header}.hpp CONTENT "${text}" @ONLY)
endforeach()

add_executable(palpate_test_handover_relaxed unit/device/handover_test.cpp)
palpate_own_target(palpate_test_handover_relaxed)
target_include_directories(palpate_test_handover_relaxed BEFORE PRIVATE ${relaxed})
target_link_libraries(palpate_test_handover_relaxed PRIVATE palpate_test_main)
foreach(case "triple buffer" ring)
  string(REPLACE " " "_" name ${case})
  add_test(NAME handover_relaxed_${name}_is_caught
    COMMAND palpate_test_handover_relaxed --no-intro "--test-case=${case}*")
  set_tests_properties(handover_relaxed_${name}_is_caught PROPERTIES LABELS unit
    PASS_REGULAR_EXPRESSION "WARNING: ThreadSanitizer: data race")
endforeach()
