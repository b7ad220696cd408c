# Finds the OpenHaptics SDK (HDAPI): OpenHaptics_FOUND, OpenHaptics_INCLUDE_DIR and the target
# OpenHaptics::HD. Looks in OH_SDK_BASE (3.x), 3DTOUCH_BASE (older) and the system's own places.
find_path(OpenHaptics_INCLUDE_DIR HD/hd.h HINTS $ENV{OH_SDK_BASE}/include $ENV{3DTOUCH_BASE}/include)
find_path(OpenHaptics_HDU_INCLUDE_DIR HDU/hduError.h HINTS ${OpenHaptics_INCLUDE_DIR}
  $ENV{OH_SDK_BASE}/utilities/include $ENV{3DTOUCH_BASE}/utilities/include)
set(hints $ENV{OH_SDK_BASE} $ENV{3DTOUCH_BASE} $ENV{OH_SDK_BASE}/utilities $ENV{3DTOUCH_BASE}/utilities)
find_library(OpenHaptics_HD_LIBRARY HD HINTS ${hints} PATH_SUFFIXES lib lib/x64/Release)
find_library(OpenHaptics_HDU_LIBRARY NAMES HDU hdu HINTS ${hints} PATH_SUFFIXES lib lib/x64/Release)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenHaptics REQUIRED_VARS OpenHaptics_INCLUDE_DIR
  OpenHaptics_HDU_INCLUDE_DIR OpenHaptics_HD_LIBRARY OpenHaptics_HDU_LIBRARY)
mark_as_advanced(OpenHaptics_INCLUDE_DIR OpenHaptics_HDU_INCLUDE_DIR OpenHaptics_HD_LIBRARY OpenHaptics_HDU_LIBRARY)

if(OpenHaptics_FOUND AND NOT TARGET OpenHaptics::HD)
  add_library(OpenHaptics::HD INTERFACE IMPORTED)  # imported: its headers are system headers, their warnings theirs
  target_include_directories(OpenHaptics::HD INTERFACE ${OpenHaptics_INCLUDE_DIR} ${OpenHaptics_HDU_INCLUDE_DIR})
  target_link_libraries(OpenHaptics::HD INTERFACE ${OpenHaptics_HDU_LIBRARY} ${OpenHaptics_HD_LIBRARY})
  if(UNIX)
    # Its headers test `linux`, which strict ISO mode does not define; its libraries need these two.
    target_compile_definitions(OpenHaptics::HD INTERFACE linux)
    target_link_libraries(OpenHaptics::HD INTERFACE rt ncurses)
  endif()
endif()
