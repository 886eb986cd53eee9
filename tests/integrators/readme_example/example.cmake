# The example of integrators/README.md, its file and its row as they stand there, in a lampyr of its own.
set(readme ${PROJECT_SOURCE_DIR}/integrators/README.md)
set(registry ${PROJECT_SOURCE_DIR}/integrators/registry.cpp)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${readme} ${registry})

# The first block of code in `text`, and what comes after it.
function(take_code text code rest)
  string(FIND "${text}" "```cpp\n" begin)
  math(EXPR begin "${begin} + 7")
  string(SUBSTRING "${text}" ${begin} -1 text)
  string(FIND "${text}" "\n```" end)
  string(SUBSTRING "${text}" 0 ${end} block)
  string(SUBSTRING "${text}" ${end} -1 text)
  set(${code} "${block}\n" PARENT_SCOPE)
  set(${rest} "${text}" PARENT_SCOPE)
endfunction()

function(write_if_different file content)
  file(WRITE ${file}.new "${content}")
  file(COPY_FILE ${file}.new ${file} ONLY_IF_DIFFERENT)
endfunction()

file(READ ${readme} text)
take_code("${text}" integrator text)
take_code("${text}" row text)
file(READ ${registry} rows)
string(REPLACE "    // clang-format on\n" "${row}    // clang-format on\n" rows "${rows}")
set(folder ${CMAKE_BINARY_DIR}/readme_example)
write_if_different(${folder}/ambient_integrator.cpp "${integrator}")
write_if_different(${folder}/registry.cpp "${rows}")

add_executable(lampyr_with_ambient ${PROJECT_SOURCE_DIR}/app/main.cpp ${folder}/registry.cpp
  ${folder}/ambient_integrator.cpp)
target_link_libraries(lampyr_with_ambient PRIVATE lampyr_app lampyr_warnings)
add_test(NAME Readme.TheIntegratorOfTheExampleWorks
  COMMAND ${CMAKE_CURRENT_LIST_DIR}/run $<TARGET_FILE:lampyr_with_ambient> ${CMAKE_BINARY_DIR}/readme_example)
set_tests_properties(Readme.TheIntegratorOfTheExampleWorks PROPERTIES LABELS cli TIMEOUT 60)
