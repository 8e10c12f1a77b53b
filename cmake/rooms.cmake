# One library target per room, so that the build enforces which room may include which (docs/architecture.md).

add_library(calot_flags INTERFACE)
# -Wno-restrict: g++ 12 sees overlaps in std::string + std::string that are not there.
# -ffp-contract=off: the compiler may not fuse multiply and add behind our back, so that results do not depend on its mood.
target_compile_options(calot_flags INTERFACE -Wall -Wextra -Wconversion -Wno-sign-conversion -Wno-restrict -Werror -ffp-contract=off -fno-math-errno)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
    # Vectors of unknown length (SVE) cannot be members of structs, which our kernels keep them in. NEON can.
    target_compile_definitions(calot_flags INTERFACE
        "HWY_DISABLED_TARGETS=(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128)")
endif()
if(CALOT_SANITIZE)
    target_compile_options(calot_flags INTERFACE -fsanitize=${CALOT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(calot_flags INTERFACE -fsanitize=${CALOT_SANITIZE})
endif()
find_program(CALOT_CCACHE ccache)
if(CALOT_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CALOT_CCACHE})
endif()
if(CMAKE_BUILD_TYPE STREQUAL "Release")
    set(CMAKE_CXX_FLAGS_RELEASE "-O3")  # asserts stay on: a broken invariant must be heard
endif()

# calot_room(NAME [NEEDS rooms...] [USES libraries...])
# NEEDS are rooms below this one, passed on to whoever uses this room; USES are outside libraries.
function(calot_room name)
    cmake_parse_arguments(ROOM "" "" "NEEDS;USES" ${ARGN})
    file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/calot/${name}/*.cpp)
    list(TRANSFORM ROOM_NEEDS PREPEND calot_)
    if(sources)
        if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
            # Substituting temporaries into later expressions keeps too many wide vectors alive: g++ 12 then spills
            # 134 of them in the force kernel instead of 2, and takes half as long again.
            set(wide ${sources})
            list(FILTER wide INCLUDE REGEX "_simd\\.cpp$")
            set_source_files_properties(${wide} PROPERTIES COMPILE_OPTIONS -fno-tree-ter)
        endif()
        add_library(calot_${name} STATIC ${sources})
        target_include_directories(calot_${name} PUBLIC ${CMAKE_SOURCE_DIR})
        target_link_libraries(calot_${name} PUBLIC ${ROOM_NEEDS} ${ROOM_USES} PRIVATE calot_flags)
    else()
        add_library(calot_${name} INTERFACE)
        target_include_directories(calot_${name} INTERFACE ${CMAKE_SOURCE_DIR})
        target_link_libraries(calot_${name} INTERFACE ${ROOM_NEEDS} ${ROOM_USES})
    endif()
endfunction()

# Kernel sources of a room (calot/NAME/kernels/*.cl and what they include) become text in its library.
function(calot_embed_kernels name)
    set(folder ${CMAKE_SOURCE_DIR}/calot/${name}/kernels)
    set(output ${CMAKE_BINARY_DIR}/${name}_kernels.cpp)
    file(GLOB kernels CONFIGURE_DEPENDS ${folder}/*)
    add_custom_command(OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -DKERNELS=${folder} -DOUTPUT=${output} -P ${CMAKE_SOURCE_DIR}/cmake/embed_kernels.cmake
        DEPENDS ${kernels} ${CMAKE_SOURCE_DIR}/cmake/embed_kernels.cmake VERBATIM)
    target_sources(calot_${name} PRIVATE ${output})
endfunction()

# The same sources as CUDA C++: where nvcc is found they are compiled for two generations of devices, with PTX for newer
# ones, and become bytes in the room's library. Without nvcc the library has no CUDA kernels (docs/gpu.md).
find_program(CALOT_NVCC nvcc PATHS /usr/local/cuda/bin)
function(calot_compile_kernels_for_cuda name)
    set(folder ${CMAKE_SOURCE_DIR}/calot/${name}/kernels)
    set(output ${CMAKE_BINARY_DIR}/${name}_cuda_modules.cpp)
    set(modules)
    if(CALOT_NVCC)
        file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cl)
        file(GLOB headers CONFIGURE_DEPENDS ${folder}/*.h)
        file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/cuda)
        foreach(source ${sources})
            get_filename_component(module ${source} NAME_WE)
            set(module ${CMAKE_BINARY_DIR}/cuda/${module}.fatbin)
            # Multiplication and addition stay separate, as on the host.
            add_custom_command(OUTPUT ${module}
                COMMAND ${CALOT_NVCC} -x cu -fatbin -fmad=false "-gencode=arch=compute_80,code=[sm_80,compute_80]"
                        -gencode=arch=compute_90,code=sm_90 -o ${module} ${source}
                DEPENDS ${source} ${headers} VERBATIM)
            list(APPEND modules ${module})
        endforeach()
    endif()
    string(REPLACE ";" "," listed "${modules}")
    add_custom_command(OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -DMODULES=${listed} -DOUTPUT=${output} -P ${CMAKE_SOURCE_DIR}/cmake/cuda_modules.cmake
        DEPENDS ${modules} ${CMAKE_SOURCE_DIR}/cmake/cuda_modules.cmake VERBATIM)
    target_sources(calot_${name} PRIVATE ${output})
endfunction()
