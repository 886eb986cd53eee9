# Third-party libraries, all from Debian. Each is linked by the one room that includes it.
find_package(embree 3 REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(Imath REQUIRED)
find_package(OpenImageIO REQUIRED)
# Debian's target names an OpenCV folder that none of its dependencies brings; configuring would fail on it.
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
  INTERFACE_INCLUDE_DIRECTORIES "${OpenImageIO_INCLUDE_DIR}" INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "")
find_package(flann REQUIRED)
find_package(glm REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(ZLIB REQUIRED)
