// SPDX-License-Identifier: MIT
// The smallest user of installed interface documents: a value becomes pixels, drawn by the process that was installed
// with the library.

#include <cstdio>
#include <darkroom/hud_document.hpp>
#include <fstream>
#include <string>

int main(int, char** arguments) {
    const std::string file = std::string(arguments[0]) + ".svg";
    std::ofstream(file) << R"(<svg xmlns="http://www.w3.org/2000/svg" width="100%" height="100%">)"
                        << R"(<rect width="{{health}}" height="8" fill="#ff0000"/></svg>)";
    auto document = darkroom::HudDocument::load(file, {.is_headless = true});
    if (!document) {
        std::fprintf(stderr, "%s\n", document.error().text.c_str());
        return 1;
    }
    (*document)->set("health", 4.0);
    const auto picture = (*document)->picture(8, 8);
    if (picture == nullptr) {
        std::fprintf(stderr, "%s\n", (*document)->error().c_str());
        return 1;
    }
    const bool is_drawn = picture->rgba[4 * 3] == 255 && picture->rgba[4 * 5 + 3] == 0;
    std::printf("a document of %u x %u %s\n", picture->width, picture->height, is_drawn ? "is drawn" : "is wrong");
    return is_drawn ? 0 : 1;
}
