# `cmake --install` gives a package: find_package(lampyr) brings the rooms as lampyr::lampyr_NAME, with their headers.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY LAMPYR_ROOMS)
foreach(room ${rooms})
  set_target_properties(${room} PROPERTIES ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
endforeach()
install(TARGETS ${rooms} lampyr_settings EXPORT lampyrTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS lampyr RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS lampyr_image_module LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/lampyr)
install(FILES ${CMAKE_BINARY_DIR}/lampyr_report_page.html DESTINATION ${CMAKE_INSTALL_LIBDIR}/lampyr OPTIONAL)
install(DIRECTORY src/ DESTINATION include/lampyr FILES_MATCHING PATTERN "*.h")
install(DIRECTORY lights suite integrators render DESTINATION include/lampyr FILES_MATCHING PATTERN "*.h")
install(EXPORT lampyrTargets NAMESPACE lampyr:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lampyr)
configure_package_config_file(cmake/lampyrConfig.cmake.in ${CMAKE_BINARY_DIR}/lampyrConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lampyr)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/lampyrConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/lampyrConfig.cmake ${CMAKE_BINARY_DIR}/lampyrConfigVersion.cmake cmake/LampyrPlugin.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lampyr)
