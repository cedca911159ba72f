# The target mpm::impl, from the mpm.c in MPM_SOURCE. A project without C goes on without it.
if(CMAKE_C_COMPILER_LOADED AND NOT TARGET mpm_impl)
    add_library(mpm_impl STATIC EXCLUDE_FROM_ALL ${MPM_SOURCE})
    add_library(mpm::impl ALIAS mpm_impl)
    set_target_properties(mpm_impl PROPERTIES C_STANDARD 99 C_EXTENSIONS OFF OUTPUT_NAME mpm)
    target_link_libraries(mpm_impl PUBLIC mpm::mpm)
    # The same bits with and without fused multiply-add.
    target_compile_options(mpm_impl PRIVATE $<$<NOT:$<C_COMPILER_ID:MSVC>>:-ffp-contract=off>)
endif()
