# make package: a Debian package of what is installed, for the release of Debian that it is built on.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Cistula authors <cistula@example.org>")  # Debian asks for an address; this one reaches nobody
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Exact ray tracer of semi-mirrors and glass")
set(CPACK_PACKAGE_DESCRIPTION "Cistula renders semi-mirror, semi-transparent solids and meshes, lit by
points, to OpenEXR: the same image, bit for bit, from any machine and any
number of threads.
.
The package holds the programs, example scenes, documents, and libraries for
CMake's find_package.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
cmake_host_system_information(RESULT _release QUERY DISTRIB_ID DISTRIB_VERSION_ID)
list(JOIN _release "" _release)
set(CPACK_DEBIAN_PACKAGE_RELEASE "1~${_release}")
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What find_package(cistula) finds, too.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "cmake, g++, libdeflate-dev, libembree-dev, libfmt-dev, libglm-dev, libopenexr-dev, libpng-dev, libqhull-dev, libtbb-dev")
include(CPack)
