// SPDX-License-Identifier: MIT
#pragma once
// What the handles of the C interface stand for.

#include <darkroom/darkroom.h>

#include <darkroom/composer.hpp>
#include <darkroom/custom_effect.hpp>
#include <darkroom/hud_inertia.hpp>
#include <darkroom/kernel_file.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

/// An effect's description with texts that end with 0.
struct DarkroomEffectObject {
    explicit DarkroomEffectObject(const darkroom::EffectInfo& description);
    DarkroomEffectObject(const DarkroomEffectObject&) = delete;
    DarkroomEffectObject& operator=(const DarkroomEffectObject&) = delete;
    const darkroom::EffectInfo* info;
    std::shared_ptr<const void> owner;  ///< of a custom effect, so that no other one comes to its place
    std::string name, doc, page;
    struct Row {
        std::string name, doc, unit;
        std::vector<std::string> choices;
        std::vector<const char*> choice_names;
    };
    std::vector<Row> rows;
};

struct DarkroomDeviceObject {
    darkroom::Device device;
};

struct DarkroomComposerObject {
    darkroom::Composer composer;
    /// What texts that were handed out refer to.
    std::map<const darkroom::EffectInfo*, std::unique_ptr<DarkroomEffectObject>> custom_effects{};
    std::vector<std::string> texts{};
    /// Of frames: as large as the largest so far, so that record() allocates nothing.
    std::vector<darkroom::Light> lights{};
    std::vector<darkroom::Watched> watched{};
};

struct DarkroomPlanObject {
    darkroom::Plan plan;
    std::string text{}, json{};
};

struct DarkroomCustomEffectObject {
    explicit DarkroomCustomEffectObject(darkroom::CustomEffect made) : custom(std::move(made)), effect(custom.info()) {}
    darkroom::CustomEffect custom;
    DarkroomEffectObject effect;
};

struct DarkroomKernelFileObject {
    darkroom::KernelFile file{};
    std::vector<std::byte> bytes{};
};

struct DarkroomHudInertiaObject {
    darkroom::HudInertia inertia{};
};

namespace darkroom::c {

/// The object of an effect of the library; null for other effects.
[[nodiscard]] DarkroomEffect effect_of(const EffectInfo& info);

[[nodiscard]] inline Handle handle_of(DarkroomHandle handle) {
    return {static_cast<std::uint32_t>(handle), (handle >> 32 & 1) != 0};
}
[[nodiscard]] inline DarkroomHandle number_of(Handle handle) {
    return handle.id | DarkroomHandle{handle.is_previous} << 32;
}

}  // namespace darkroom::c
