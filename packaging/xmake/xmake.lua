-- SPDX-License-Identifier: MIT
-- A package of the tree that it lies in, and a host of it: includes("darkroom/packaging/xmake") and add_requires("darkroom")
-- in an xmake.lua (docs/packaging.md).
package("darkroom")
    set_description("Post-processing for Vulkan")
    set_license("MIT")
    set_sourcedir(path.join(os.scriptdir(), "..", ".."))
    add_links("darkroom_cpp")
    -- So that a host finds it where it was built.
    add_configs("shared", {description = "Build shared library.", default = true, type = "boolean", readonly = true})
    on_install(function (package)
        import("package.tools.cmake").install(package, {
            "-DDARKROOM_APPS=OFF", "-DDARKROOM_LOOKS=OFF", "-DDARKROOM_SCRIPT=OFF", "-DDARKROOM_TESTS=OFF",
            "-DDARKROOM_COMPILER=AUTO", "-DCMAKE_INSTALL_LIBDIR=lib",
            "-DCMAKE_BUILD_TYPE=" .. (package:is_debug() and "Debug" or "Release")}, {cmake_generator = "Ninja"})
    end)
    on_test(function (package)
        assert(package:check_cxxsnippets({test = [[
            int test() { return darkroom::find_effect("bloom") == nullptr; }
        ]]}, {configs = {languages = "c++20"}, includes = "darkroom/darkroom.hpp"}))
    end)
package_end()
