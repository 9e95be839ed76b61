# find_package(CALLED CONFIG) with CMAKE_PREFIX_PATH at this folder gives the targets
# CALLED::shared and CALLED::static.
get_filename_component(_bricard_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

if(NOT TARGET CALLED::shared)
    add_library(CALLED::shared SHARED IMPORTED)
    set_target_properties(CALLED::shared PROPERTIES
        IMPORTED_NO_SONAME TRUE
        IMPORTED_LOCATION "${_bricard_prefix}/lib/SHARED"
        INTERFACE_INCLUDE_DIRECTORIES "${_bricard_prefix}/include")
    add_library(CALLED::static STATIC IMPORTED)
    set_target_properties(CALLED::static PROPERTIES
        IMPORTED_LOCATION "${_bricard_prefix}/lib/FIXED"
        INTERFACE_INCLUDE_DIRECTORIES "${_bricard_prefix}/include"
        INTERFACE_LINK_LIBRARIES "NATIVE")
endif()
unset(_bricard_prefix)
