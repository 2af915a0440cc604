# Each *_fuzz.cpp is a libFuzzer target, run by ctest (label fuzz) for RAPPORT_FUZZ_SECONDS from
# small sound files; what it finds is left as crash-… in its folder of the build. For longer:
#   build/fuzz/tests/bsdf_fuzz -max_total_time=600 build/fuzz/tests/fuzz/bsdf
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "RAPPORT_FUZZ: libFuzzer comes with clang alone")
endif()

set(corpora ${CMAKE_CURRENT_BINARY_DIR}/fuzz)
add_executable(make_seeds fuzz/make_seeds.cpp)
target_link_libraries(make_seeds PRIVATE rapport_tests_support)
rapport_link_included(make_seeds ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/make_seeds.cpp)
add_custom_target(fuzz_tests DEPENDS make_seeds)
add_test(NAME fuzz/make_seeds COMMAND make_seeds ${corpora})
set_tests_properties(fuzz/make_seeds PROPERTIES LABELS fuzz FIXTURES_SETUP seeds)

file(GLOB files CONFIGURE_DEPENDS fuzz/*_fuzz.cpp)
foreach(file ${files})
  get_filename_component(name ${file} NAME_WE)
  string(REPLACE _fuzz "" corpus ${name})
  add_executable(${name} ${file})
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
  target_link_libraries(${name} PRIVATE rapport_tests_support)
  rapport_link_included(${name} ${file})
  add_dependencies(fuzz_tests ${name})
  add_test(NAME fuzz/${corpus} COMMAND ${name} -max_total_time=${RAPPORT_FUZZ_SECONDS}
    -timeout=10 -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1
    -artifact_prefix=${corpora}/${corpus}- ${corpora}/${corpus})
  set_tests_properties(fuzz/${corpus} PROPERTIES LABELS fuzz FIXTURES_REQUIRED seeds)
endforeach()
