# Third-party libraries, all from Debian. Each is linked by the one room that includes it.
find_package(embree 3 REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(Imath REQUIRED)
find_package(flann REQUIRED)
find_package(glm REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)  # headers alone
find_path(NANOVDB_INCLUDE_DIR nanovdb/NanoVDB.h REQUIRED)  # headers alone

# Debian's OpenImageIO package file demands the command-line tools and an OpenCV folder that its library does not need:
# the library and its headers are looked for directly.
find_path(OPENIMAGEIO_INCLUDE_DIR OpenImageIO/imageio.h REQUIRED)
find_library(OPENIMAGEIO_LIBRARY OpenImageIO REQUIRED)
find_library(OPENIMAGEIO_UTIL_LIBRARY OpenImageIO_Util REQUIRED)
add_library(lampyr_openimageio INTERFACE)
target_include_directories(lampyr_openimageio SYSTEM INTERFACE ${OPENIMAGEIO_INCLUDE_DIR})
target_link_libraries(lampyr_openimageio INTERFACE ${OPENIMAGEIO_LIBRARY} ${OPENIMAGEIO_UTIL_LIBRARY} Imath::Imath)

# Debian's cpp-httplib (MIT) is a library, and its header has to be told how that was built. Encryption and compression, which
# it was built with, are not used.
find_path(HTTPLIB_INCLUDE_DIR httplib.h REQUIRED)
find_library(HTTPLIB_LIBRARY cpp-httplib REQUIRED)
set(HTTPLIB_DEFINITIONS CPPHTTPLIB_OPENSSL_SUPPORT CPPHTTPLIB_ZLIB_SUPPORT CPPHTTPLIB_BROTLI_SUPPORT)
