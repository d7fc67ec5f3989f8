// SPDX-License-Identifier: MIT
// The smallest user of the installed library: what it was compiled with is what it runs with, and a stack compiles.

#include <cstdio>
#include <darkroom/darkroom.hpp>
#include <darkroom/look.hpp>

int main() {
    if (darkroom::library_version() != darkroom::version) return 1;
    auto device = darkroom::Device::create();
    if (!device) {
        std::fprintf(stderr, "%s\n", device.error().text.c_str());
        return 2;
    }
    darkroom::Composer composer(*device);
    for (const darkroom::EffectInfo* const effect : darkroom::all_effects())
        composer.add(*effect, nullptr, {.second = darkroom::scene_color});
    const auto plan = composer.compile({.max_extent = {64, 64}});
    if (!plan) {
        std::fprintf(stderr, "%s\n", plan.error().text.c_str());
        return 1;
    }
    std::printf("%zu effects in %zu passes on %s\n", composer.size(), plan->passes.size(), device->info().name.c_str());
    return plan->passes.empty() ? 1 : 0;
}
