# lampyr_plugin(NAME SOURCES FILE…): a plugin NAME.so for lampyr, with types of lights and light filters. It is compiled
# against the installed headers and links no library: its symbols come from the lampyr that loads it.
function(lampyr_plugin name)
  cmake_parse_arguments(PLUGIN "" "" "SOURCES" ${ARGN})
  add_library(${name} MODULE ${PLUGIN_SOURCES})
  target_link_libraries(${name} PRIVATE lampyr::lampyr_settings)
  # Hidden: two plugins may have classes of the same name.
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()
