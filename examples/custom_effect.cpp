// SPDX-License-Identifier: MIT
// A user's own effect: duotone.glsl, one file with described parameters, loaded at run time. It goes into a stack like
// any other, fuses with its neighbours, and its parameters are listed, set and checked by name.
//     custom_effect [EFFECT.glsl]

#include <cstdio>
#include <darkroom/darkroom.hpp>

namespace {

int fail(const darkroom::Error& error) {
    std::fprintf(stderr, "custom_effect: %s\n", error.text.c_str());
    return error.fault == darkroom::Fault::User ? 1 : 2;
}

}  // namespace

int main(int argc, char** argv) {
    const auto effect = darkroom::CustomEffect::load(argc > 1 ? argv[1] : "duotone.glsl");
    if (!effect) return fail(effect.error());
    const darkroom::EffectInfo& info = effect->info();
    std::printf("%.*s: %.*s\n", static_cast<int>(info.name.size()), info.name.data(), static_cast<int>(info.doc.size()),
                info.doc.data());
    for (const darkroom::ParamInfo& row : info.parameters.rows)
        std::printf("  %.*s: %.*s\n", static_cast<int>(row.name.size()), row.name.data(),
                    static_cast<int>(row.doc.size()), row.doc.data());

    auto device = darkroom::Device::create();
    if (!device) return fail(device.error());
    darkroom::Composer composer(*device);
    composer.add(darkroom::Exposure{.exposure = 1.5f});
    composer.add(darkroom::Tonemap{});
    const darkroom::Handle custom = composer.add(info, nullptr);
    composer.add(darkroom::Encode{});

    if (info.parameters.find("amount") != nullptr) {
        if (const auto set = composer.set(custom, "amount", 0.6); !set) return fail(set.error());
        const auto refused = composer.set(custom, "amount", 2.0);
        std::printf("refused: %s\n", refused ? "nothing" : refused.error().text.c_str());
    }
    const auto plan = composer.compile({.max_extent = {1920, 1080}});
    if (!plan) return fail(plan.error());
    std::printf("%s", plan->text().c_str());
    // Everything here is pointwise, so all of it is one pass.
    return plan->passes.size() == 1 ? 0 : 1;
}
