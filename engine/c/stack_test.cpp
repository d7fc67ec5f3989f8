// SPDX-License-Identifier: MIT
// The C interface without a driver: stacks, values, plans, looks and errors, held against the C++ interface.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <darkroom/effects.hpp>
#include <darkroom/effects/blend.hpp>
#include <darkroom/effects/bloom.hpp>
#include <darkroom/effects/encode.hpp>
#include <darkroom/effects/tonemap.hpp>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "c/frame_of.hpp"

namespace darkroom {
namespace {

template <class T>
T sized() {
    T out{};
    out.struct_size = sizeof out;
    return out;
}

/// A stack on an assumed device.
struct CStack {
    CStack() {
        EXPECT_EQ(darkroom_device_assumed(DARKROOM_DEVICE_PROFILE_GPU, &device), DARKROOM_OK);
        EXPECT_EQ(darkroom_composer_create(device, nullptr, &composer), DARKROOM_OK);
    }
    CStack(const CStack&) = delete;
    CStack& operator=(const CStack&) = delete;
    ~CStack() {
        darkroom_composer_destroy(composer);
        darkroom_device_destroy(device);
    }
    DarkroomHandle add(const char* effect, const DarkroomEntryDesc* desc = nullptr) const {
        DarkroomHandle handle = 0;
        EXPECT_EQ(darkroom_composer_add(composer, effect, desc, &handle), DARKROOM_OK) << darkroom_error();
        return handle;
    }
    [[nodiscard]] std::string plan() const {
        auto desc = sized<DarkroomCompileDesc>();
        desc.max_extent = {640, 360};
        DarkroomPlan made = nullptr;
        EXPECT_EQ(darkroom_composer_plan(composer, &desc, &made), DARKROOM_OK) << darkroom_error();
        const std::string out = darkroom_plan_json(made);
        darkroom_plan_destroy(made);
        return out;
    }
    DarkroomDevice device = nullptr;
    DarkroomComposer composer = nullptr;
};

void expect_error(DarkroomResult result, const char* text, DarkroomResult code = DARKROOM_ERROR_USER) {
    EXPECT_EQ(result, code);
    EXPECT_STREQ(darkroom_error(), text);
}

TEST(CInterface, PlansWhatCppPlans) {
    const CStack stack;
    const DarkroomHandle bloom = stack.add("bloom");
    ASSERT_EQ(darkroom_composer_set_number(stack.composer, bloom, "intensity", 0.5), DARKROOM_OK);
    auto blend = sized<DarkroomEntryDesc>();
    blend.input = DARKROOM_SCENE_COLOR;
    blend.second = darkroom_handle_previous(bloom);
    blend.blend = DARKROOM_BLEND_SCREEN;
    blend.opacity = 0.5f;
    blend.scale_denominator = 2;
    stack.add("blend", &blend);
    stack.add("tonemap");
    stack.add("encode");

    Composer composer(Device::assumed());
    const Handle same = composer.add(Bloom{.intensity = 0.5f});
    composer.add(Blend{}, {.input = scene_color,
                           .second = same.previous(),
                           .opacity = 0.5f,
                           .blend = BlendMode::Screen,
                           .scale = {1, 2}});
    composer.add(Tonemap{});
    composer.add(Encode{});
    EXPECT_EQ(stack.plan(), composer.plan({.max_extent = {640, 360}})->json());
}

TEST(CInterface, ZeroIsTheDefaultOfEveryStruct) {
    const CStack stack;
    const auto entry = sized<DarkroomEntryDesc>();
    stack.add("tonemap", &entry);
    auto read = sized<DarkroomEntryDesc>();
    DarkroomHandle handle = 0;
    ASSERT_EQ(darkroom_composer_find(stack.composer, "tonemap", &handle), DARKROOM_OK);
    ASSERT_EQ(darkroom_composer_desc(stack.composer, handle, &read), DARKROOM_OK);
    EXPECT_EQ(read.opacity, 1);
    EXPECT_EQ(read.is_disabled, 0u);
    EXPECT_EQ(read.scale_numerator, 1u);
    const auto& table = find_effect("tonemap")->parameters;
    ASSERT_EQ(read.word_count, table.words());
    EXPECT_TRUE(std::equal(read.words, read.words + read.word_count, table.defaults.begin()));
}

TEST(CInterface, AZeroFrameIsTheDefaultFrame) {
    const CStack stack;
    const auto no_image = sized<DarkroomImage>();
    auto zero = sized<DarkroomFrame>();
    auto light = sized<DarkroomLight>();
    const auto camera = sized<DarkroomCamera>();
    zero.color = &no_image;
    zero.camera = &camera;
    zero.lights = &light;
    zero.light_count = 1;
    const auto frame = c::frame_of(&zero, *stack.composer);
    ASSERT_TRUE(frame) << frame.error().text;
    const Frame wanted;
    EXPECT_EQ(frame->delta_time, wanted.delta_time);
    EXPECT_EQ(frame->color.layer_count, wanted.color.layer_count);
    EXPECT_EQ(frame->color.last_stages, wanted.color.last_stages);
    EXPECT_EQ(frame->color.last_access, wanted.color.last_access);
    EXPECT_EQ(frame->color.final_stages, wanted.color.final_stages);
    EXPECT_EQ(frame->color.final_access, wanted.color.final_access);
    const Camera& is = frame->camera;
    EXPECT_EQ(is.view, identity_matrix);
    EXPECT_EQ(is.previous_projection, identity_matrix);
    EXPECT_EQ(is.near_distance, wanted.camera.near_distance);
    EXPECT_EQ(is.far_distance, wanted.camera.far_distance);
    EXPECT_EQ(is.is_y_down, wanted.camera.is_y_down);
    EXPECT_EQ(is.velocity, wanted.camera.velocity);
    EXPECT_EQ(is.jump_distance, wanted.camera.jump_distance);
    EXPECT_EQ(is.jump_angle, wanted.camera.jump_angle);
    ASSERT_EQ(frame->lights.size(), 1u);
    EXPECT_EQ(frame->lights[0].direction, Light{}.direction);
    EXPECT_EQ(frame->lights[0].color, Light{}.color);
    EXPECT_EQ(frame->lights[0].world_to_cascade, Light{}.world_to_cascade);

    const auto frames = sized<DarkroomCompileDesc>();
    const auto desc = c::compile_desc_of(&frames);
    ASSERT_TRUE(desc) << desc.error().text;
    EXPECT_EQ(desc->color, CompileDesc{}.color);
    EXPECT_EQ(desc->target, CompileDesc{}.target);
    EXPECT_EQ(desc->depth, CompileDesc{}.depth);
    EXPECT_EQ(desc->views, CompileDesc{}.views);
    EXPECT_EQ(desc->fuse, CompileDesc{}.fuse);
    EXPECT_EQ(desc->intermediate, CompileDesc{}.intermediate);
    EXPECT_FALSE(desc->target_color || desc->target_domain || desc->encodes_target);
}

TEST(CInterface, WhatAFrameSaysArrives) {
    const CStack stack;
    auto image = sized<DarkroomImage>();
    image.mip_level = 1;
    image.array_layer = 2;
    image.layer_count = 3;
    image.region = {{4, 5}, {6, 7}};
    image.has_barrier_before = VK_TRUE;
    image.final_stages = VK_PIPELINE_STAGE_2_COPY_BIT;
    auto camera = sized<DarkroomCamera>();
    camera.depth = DARKROOM_DEPTH_REVERSED;
    camera.is_y_up = camera.is_velocity_y_up = camera.velocity_has_jitter = camera.is_cut = VK_TRUE;
    camera.velocity_sign = DARKROOM_VELOCITY_CURRENT_MINUS_PREVIOUS;
    camera.velocity_unit = DARKROOM_VELOCITY_NDC;
    for (int i = 0; i < 16; ++i) camera.previous_view[i] = static_cast<float>(i);
    camera.jitter[1] = 0.25f;
    camera.previous_jitter[0] = 0.125f;
    // A light of a newer program's, twice.
    struct {
        DarkroomLight known;
        std::uint64_t newer;
    } lights[2]{};
    lights[0].known.struct_size = lights[1].known.struct_size = sizeof lights[0];
    lights[1].known.cascade_count = 2;
    lights[1].known.splits[1] = 9;
    lights[1].known.world_to_cascade[16] = 8;
    lights[1].known.cascades = &image;
    auto watched = sized<DarkroomWatched>();
    watched.id = 11;
    watched.target = &image;
    auto zero = sized<DarkroomFrame>();
    zero.view = 3;
    zero.normals = zero.exposure = &image;
    zero.camera = &camera;
    zero.lights = &lights[0].known;
    zero.light_count = 2;
    zero.watched = &watched;
    zero.watched_count = 1;
    zero.frame_index = 12;
    zero.time = 13;
    zero.delta_time = -1;
    const auto frame = c::frame_of(&zero, *stack.composer);
    ASSERT_TRUE(frame) << frame.error().text;
    for (const ImageRef* is :
         {&frame->normals, &frame->exposure, &frame->lights[1].cascades, &frame->watched[0].target}) {
        EXPECT_EQ(is->mip_level, 1u);
        EXPECT_EQ(is->array_layer, 2u);
        EXPECT_EQ(is->layer_count, 3u);
        EXPECT_EQ(is->region.offset.y, 5);
        EXPECT_EQ(is->last_stages, VK_PIPELINE_STAGE_2_NONE);
        EXPECT_EQ(is->last_access, VK_ACCESS_2_NONE);
        EXPECT_EQ(is->final_stages, VK_PIPELINE_STAGE_2_COPY_BIT);
        EXPECT_EQ(is->final_access, VK_ACCESS_2_NONE);
    }
    EXPECT_EQ(frame->view, 3u);
    EXPECT_EQ(frame->frame_index, 12u);
    EXPECT_EQ(frame->time, 13);
    EXPECT_EQ(frame->delta_time, -1);
    EXPECT_EQ(frame->watched[0].id, 11u);
    EXPECT_EQ(frame->camera.depth, DepthKind::Reversed);
    EXPECT_FALSE(frame->camera.is_y_down);
    EXPECT_TRUE(frame->camera.is_cut);
    EXPECT_EQ(frame->camera.velocity,
              (VelocityKind{VelocityKind::Sign::CurrentMinusPrevious, VelocityKind::Unit::Ndc, false, true}));
    EXPECT_EQ(frame->camera.previous_view[5], 5);
    EXPECT_EQ(frame->camera.jitter[1], 0.25f);
    EXPECT_EQ(frame->camera.previous_jitter[0], 0.125f);
    EXPECT_EQ(frame->lights[1].cascade_count, 2u);
    EXPECT_EQ(frame->lights[1].splits[1], 9);
    EXPECT_EQ(frame->lights[1].world_to_cascade[1][0], 8);
}

TEST(CInterface, ValuesByNameTextWordsAndNumber) {
    const CStack stack;
    const DarkroomHandle tonemap = stack.add("tonemap");
    const DarkroomHandle grade = stack.add("color_grade");
    EXPECT_EQ(darkroom_composer_set_text(stack.composer, tonemap, "curve", "agx"), DARKROOM_OK) << darkroom_error();
    const ParamInfo& curve = *find_effect("tonemap")->parameters.find("curve");
    const auto words = stack.composer->composer.words(c::handle_of(tonemap));
    EXPECT_EQ(curve.choices[words[curve.word]], "agx");
    EXPECT_EQ(darkroom_composer_set_number(stack.composer, tonemap, "curve", 0), DARKROOM_OK);
    EXPECT_EQ(words[curve.word], 0u);
    EXPECT_EQ(darkroom_composer_set_number(stack.composer, tonemap, "curve", 0.5), DARKROOM_ERROR_USER);
    EXPECT_EQ(darkroom_composer_set_text(stack.composer, grade, "tint", "0.1 0.2"), DARKROOM_ERROR_USER);
    EXPECT_EQ(darkroom_composer_set_text(stack.composer, tonemap, "curve", "agxx"), DARKROOM_ERROR_USER);
    EXPECT_NE(std::string_view(darkroom_error()).find("agx"), std::string_view::npos) << darkroom_error();
    std::uint32_t count = 1;
    std::uint32_t first = ~0u;
    EXPECT_EQ(darkroom_composer_words(stack.composer, tonemap, &first, &count), DARKROOM_OK);
    EXPECT_EQ(first, words[0]);
    EXPECT_EQ(count, words.size());
}

TEST(CInterface, AParameterFoundOnceIsSetUntilItsEntryIsAnother) {
    const CStack stack;
    const DarkroomHandle first = stack.add("exposure"), bloom = stack.add("bloom");
    DarkroomParameter intensity = 0;
    ASSERT_EQ(darkroom_composer_parameter(stack.composer, bloom, "intensity", &intensity), DARKROOM_OK);
    const auto value = [&] {
        const ParamInfo& row = *find_effect("bloom")->parameters.find("intensity");
        return std::bit_cast<float>(stack.composer->composer.words(c::handle_of(bloom))[row.word]);
    };
    EXPECT_EQ(darkroom_composer_set_float(stack.composer, intensity, 0.25f), DARKROOM_OK);
    EXPECT_EQ(value(), 0.25f);
    // Another place in the stack, another wire.
    ASSERT_EQ(darkroom_composer_remove(stack.composer, first), DARKROOM_OK);
    auto desc = sized<DarkroomEntryDesc>();
    desc.source = DARKROOM_SCENE_COLOR;
    ASSERT_EQ(darkroom_composer_rewire(stack.composer, bloom, &desc), DARKROOM_OK);
    EXPECT_EQ(darkroom_composer_set_float(stack.composer, intensity, 0.75f), DARKROOM_OK);
    EXPECT_EQ(value(), 0.75f);
    EXPECT_EQ(darkroom_composer_set_float(stack.composer, intensity, -1), DARKROOM_ERROR_USER);
    EXPECT_EQ(darkroom_composer_set_float(stack.composer, intensity, std::nanf("")), DARKROOM_ERROR_USER);
    const float two[]{0.5f, 0.5f};
    EXPECT_EQ(darkroom_composer_set_vector(stack.composer, intensity, two, 2), DARKROOM_ERROR_USER);
    EXPECT_EQ(value(), 0.75f);
    // The same handle, but the rows of another effect.
    ASSERT_EQ(darkroom_composer_replace(stack.composer, bloom, darkroom_effect_find("vignette")), DARKROOM_OK);
    EXPECT_EQ(darkroom_composer_set_float(stack.composer, intensity, 0.5f), DARKROOM_ERROR_USER);
    EXPECT_EQ(darkroom_composer_set_float(stack.composer, 0, 0.5f), DARKROOM_ERROR_USER);
}

TEST(CInterface, ReflectionIsThatOfTheRows) {
    ASSERT_EQ(darkroom_effect_count(), all_effects().size());
    for (std::uint32_t i = 0; i < darkroom_effect_count(); ++i) {
        const EffectInfo& is = *all_effects()[i];
        const DarkroomEffect effect = darkroom_effect_at(i);
        EXPECT_EQ(effect, darkroom_effect_find(std::string(is.name).c_str()));
        auto info = sized<DarkroomEffectInfo>();
        ASSERT_EQ(darkroom_effect_info(effect, &info), DARKROOM_OK);
        EXPECT_EQ(info.name, is.name);
        EXPECT_EQ(info.parameter_count, is.parameters.rows.size());
        EXPECT_EQ(info.page[0], '#') << is.name;
        for (std::uint32_t row = 0; row < info.parameter_count; ++row) {
            const ParamInfo& expected = is.parameters.rows[row];
            auto got = sized<DarkroomParameterInfo>();
            ASSERT_EQ(darkroom_effect_parameter(effect, row, &got), DARKROOM_OK);
            EXPECT_EQ(got.name, expected.name);
            EXPECT_EQ(got.doc, expected.doc);
            EXPECT_EQ(got.unit, expected.unit.symbol);
            EXPECT_EQ(got.min, expected.range.min);
            EXPECT_EQ(got.max, expected.range.max);
            EXPECT_EQ(static_cast<Kind>(got.kind), expected.kind);
            ASSERT_EQ(got.choice_count, expected.choices.size());
            for (std::uint32_t choice = 0; choice < got.choice_count; ++choice)
                EXPECT_EQ(got.choices[choice], expected.choices[choice]);
            EXPECT_EQ(*got.default_words, is.parameters.defaults[expected.word]);
        }
        auto beyond = sized<DarkroomParameterInfo>();
        EXPECT_EQ(darkroom_effect_parameter(effect, info.parameter_count, &beyond), DARKROOM_ERROR_USER);
    }
    EXPECT_EQ(darkroom_effect_at(darkroom_effect_count()), nullptr);
    EXPECT_EQ(darkroom_effect_find("blom"), nullptr);
}

TEST(CInterface, ErrorsNameFunctionThingAndWhatIsAllowed) {
    const CStack stack;
    expect_error(darkroom_composer_add(stack.composer, "blom", nullptr, nullptr),
                 "darkroom_composer_add: effect 'blom': there is none of that name, did you mean 'bloom'?");
    expect_error(darkroom_composer_add(nullptr, "bloom", nullptr, nullptr),
                 "darkroom_composer_add: composer: it is null");
    const DarkroomHandle bloom = stack.add("bloom");
    expect_error(darkroom_composer_set_opacity(stack.composer, bloom, 2),
                 "darkroom_composer_set_opacity: bloom: opacity = 2: allowed is [0, 1]");
    auto desc = sized<DarkroomEntryDesc>();
    const std::int32_t none = 9;
    std::memcpy(&desc.blend, &none, sizeof none);
    expect_error(darkroom_composer_add(stack.composer, "bloom", &desc, nullptr),
                 "darkroom_composer_add: blend = 9: allowed is 0 to 8");
    DarkroomHandle untouched = 77;
    EXPECT_NE(darkroom_composer_add(stack.composer, "bloom", &desc, &untouched), DARKROOM_OK);
    EXPECT_EQ(untouched, 77u);
    // What worked leaves the last error as it was.
    EXPECT_EQ(darkroom_composer_set_opacity(stack.composer, bloom, 1), DARKROOM_OK);
    EXPECT_STREQ(darkroom_error(), "darkroom_composer_add: blend = 9: allowed is 0 to 8");
    auto frames = sized<DarkroomCompileDesc>();
    frames.max_extent = {64, 64};
    EXPECT_NE(darkroom_composer_compile(stack.composer, &frames, nullptr), DARKROOM_OK);
}

TEST(CInterface, StructsOfOtherVersions) {
    const CStack stack;
    // A newer program: what this version does not know may be there, and zero.
    struct {
        DarkroomEntryDesc known;
        std::uint64_t newer;
    } desc{};
    desc.known.struct_size = sizeof desc;
    EXPECT_EQ(darkroom_composer_add(stack.composer, "bloom", &desc.known, nullptr), DARKROOM_OK) << darkroom_error();
    desc.newer = 1;
    expect_error(
        darkroom_composer_add(stack.composer, "bloom", &desc.known, nullptr),
        fmt::format("darkroom_composer_add: DarkroomEntryDesc: a member after its first {} bytes is set, which "
                    "this version does not know",
                    sizeof(DarkroomEntryDesc))
            .c_str());
    // A size that was forgotten.
    const DarkroomEntryDesc forgotten{};
    EXPECT_EQ(darkroom_composer_add(stack.composer, "bloom", &forgotten, nullptr), DARKROOM_ERROR_USER);
    // Arrays go by the size of their first.
    struct {
        DarkroomLayerValue known;
        std::uint64_t newer;
    } values[2]{};
    const float half = 0.5f, quarter = 0.25f;
    DarkroomHandle bloom = 0;
    ASSERT_EQ(darkroom_composer_find(stack.composer, "bloom", &bloom), DARKROOM_OK);
    for (auto& value : values) value.known = {sizeof value, 1, bloom, "intensity", nullptr};
    values[0].known.words = reinterpret_cast<const std::uint32_t*>(&half);
    values[1].known.parameter = "opacity";
    values[1].known.words = reinterpret_cast<const std::uint32_t*>(&quarter);
    auto layer = sized<DarkroomLayerDesc>();
    layer.name = "dusk";
    layer.weight = 1;
    layer.values = &values[0].known;
    layer.value_count = 2;
    ASSERT_EQ(darkroom_composer_add_layer(stack.composer, &layer), DARKROOM_OK) << darkroom_error();
    std::uint32_t count = 0;
    float opacity = 0;
    ASSERT_EQ(darkroom_composer_values_at(stack.composer, bloom, 0, nullptr, nullptr, &count, nullptr, &opacity),
              DARKROOM_OK);
    EXPECT_EQ(opacity, 0.25f);
    EXPECT_STREQ(darkroom_composer_layer_name(stack.composer, 0), "dusk");
    EXPECT_EQ(darkroom_composer_layer_name(stack.composer, 1), nullptr);
}

TEST(CInterface, ObjectsGoInAnyOrder) {
    DarkroomDevice device = nullptr;
    DarkroomComposer composer = nullptr;
    DarkroomCustomEffect custom = nullptr;
    DarkroomLook look = nullptr;
    ASSERT_EQ(darkroom_device_assumed(DARKROOM_DEVICE_PROFILE_GPU, &device), DARKROOM_OK);
    ASSERT_EQ(darkroom_composer_create(device, nullptr, &composer), DARKROOM_OK);
    ASSERT_EQ(darkroom_custom_effect_parse("// @effect plain: Does nothing.\n// @accepts scene_linear\n"
                                           "vec4 plain(vec4 color, Pixel pixel, Plain parameters) { return color; }\n",
                                           "plain.glsl", &custom),
              DARKROOM_OK);
    std::string name = "mine";
    auto entry = sized<DarkroomEntryDesc>();
    entry.name = name.c_str();
    DarkroomHandle handle = 0;
    ASSERT_EQ(darkroom_composer_add_effect(composer, darkroom_custom_effect_info(custom), &entry, &handle),
              DARKROOM_OK);
    darkroom_device_destroy(device);
    darkroom_custom_effect_destroy(custom);
    name = "gone";
    const DarkroomResult read =
        darkroom_look_parse("format = 1\n[post_process]\nbloom_enabled = true\n", "look.toml", nullptr, &look);
    if (read == DARKROOM_OK) {
        ASSERT_EQ(darkroom_look_apply(look, composer, nullptr), DARKROOM_OK) << darkroom_error();
        darkroom_look_destroy(look);
    }

    auto desc = sized<DarkroomCompileDesc>();
    desc.max_extent = {64, 64};
    DarkroomPlan plan = nullptr;
    ASSERT_EQ(darkroom_composer_plan(composer, &desc, &plan), DARKROOM_OK) << darkroom_error();
    DarkroomEffect effect = nullptr;
    ASSERT_EQ(darkroom_composer_find(composer, "mine", &handle), DARKROOM_OK) << darkroom_error();
    ASSERT_EQ(darkroom_composer_info(composer, handle, &effect), DARKROOM_OK);
    auto info = sized<DarkroomEffectInfo>();
    ASSERT_EQ(darkroom_effect_info(effect, &info), DARKROOM_OK);
    EXPECT_STREQ(info.name, "plain");
    darkroom_composer_destroy(composer);
    EXPECT_NE(std::strstr(darkroom_plan_text(plan), "mine"), nullptr);
    darkroom_plan_destroy(plan);
    darkroom_device_destroy(nullptr);
    darkroom_plan_destroy(nullptr);
}

TEST(CInterface, ThreadsShareADeviceAndHaveErrorsOfTheirOwn) {
    const CStack stack;
    darkroom_composer_set_number(stack.composer, stack.add("exposure"), "exposure", -1);
    const std::string own = darkroom_error();
    ASSERT_NE(own, "");
    std::vector<std::string> plans(4), errors(4);
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < plans.size(); ++i)
        threads.emplace_back([&, i] {
            DarkroomComposer composer = nullptr;
            DarkroomPlan plan = nullptr;
            auto desc = sized<DarkroomCompileDesc>();
            desc.max_extent = {640, 360};
            darkroom_composer_create(stack.device, nullptr, &composer);
            darkroom_composer_add(composer, "bloom", nullptr, nullptr);
            if (darkroom_composer_plan(composer, &desc, &plan) == DARKROOM_OK) plans[i] = darkroom_plan_json(plan);
            darkroom_composer_add(composer, ("none" + std::to_string(i)).c_str(), nullptr, nullptr);
            errors[i] = darkroom_error();
            darkroom_plan_destroy(plan);
            darkroom_composer_destroy(composer);
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(darkroom_error(), own);
    for (std::size_t i = 0; i < plans.size(); ++i) {
        EXPECT_NE(plans[i], "");
        EXPECT_EQ(plans[i], plans[0]);
        EXPECT_EQ(errors[i].find("darkroom_composer_add: effect 'none" + std::to_string(i) + "'"), 0u) << errors[i];
    }
}

TEST(CInterface, TablesAndPicturesAreCopied) {
    const CStack stack;
    std::vector<float> cube(3 * 8, 0.5f);
    auto table = sized<DarkroomTable>();
    table.size = 2;
    table.cube = cube.data();
    std::uint32_t resource = 0;
    ASSERT_EQ(darkroom_composer_define_table(stack.composer, &table, &resource), DARKROOM_OK) << darkroom_error();
    cube.assign(cube.size(), 0);
    const auto* const kept = find_resource<ColorTable>(&stack.composer->composer.resources(), Resource{resource});
    ASSERT_NE(kept, nullptr);
    EXPECT_EQ(kept->cube[5], 0.5f);
    EXPECT_EQ(kept->max[0], 1);
    table.size = 257;
    EXPECT_EQ(darkroom_composer_define_table(stack.composer, &table, &resource), DARKROOM_ERROR_USER);
    auto picture = sized<DarkroomPicture>();
    picture.width = picture.height = 2;
    EXPECT_EQ(darkroom_composer_define_picture(stack.composer, &picture, &resource), DARKROOM_ERROR_USER);
    picture.rgba = cube.data();
    ASSERT_EQ(darkroom_composer_define_picture(stack.composer, &picture, &resource), DARKROOM_OK);
    auto entry = sized<DarkroomEntryDesc>();
    entry.second = darkroom_composer_picture_of(resource);
    stack.add("blend", &entry);
    std::uint32_t count = 0;
    EXPECT_EQ(darkroom_composer_resources(stack.composer, nullptr, &count), DARKROOM_OK);
    EXPECT_EQ(count, 2u);
    EXPECT_EQ(darkroom_composer_forget(stack.composer, resource), DARKROOM_OK);
    EXPECT_EQ(darkroom_composer_resources(stack.composer, nullptr, &count), DARKROOM_OK);
    EXPECT_EQ(count, 1u);
}

TEST(CInterface, CustomEffectsAreEffects) {
    DarkroomCustomEffect custom = nullptr;
    const char* const text =
        "// @effect halved: Half the light.\n"
        "// @param float amount = 0.5 in [0, 1]: What is left.\n"
        "vec4 halved(vec4 color, Pixel pixel, Halved parameters) { return color * parameters.amount; }\n";
    ASSERT_EQ(darkroom_custom_effect_parse(text, "halved.glsl", &custom), DARKROOM_OK) << darkroom_error();
    const CStack stack;
    DarkroomHandle handle = 0;
    ASSERT_EQ(darkroom_composer_add_effect(stack.composer, darkroom_custom_effect_info(custom), nullptr, &handle),
              DARKROOM_OK)
        << darkroom_error();
    darkroom_custom_effect_destroy(custom);
    DarkroomEffect effect = nullptr;
    ASSERT_EQ(darkroom_composer_info(stack.composer, handle, &effect), DARKROOM_OK);
    auto info = sized<DarkroomEffectInfo>();
    ASSERT_EQ(darkroom_effect_info(effect, &info), DARKROOM_OK);
    EXPECT_STREQ(info.name, "halved");
    EXPECT_NE(stack.plan().find("halved"), std::string::npos);
    EXPECT_EQ(darkroom_custom_effect_parse("no effect", "x.glsl", &custom), DARKROOM_ERROR_USER);
    EXPECT_EQ(std::string_view(darkroom_error()).find("darkroom_custom_effect_parse: x.glsl:"), 0u) << darkroom_error();
}

TEST(CInterface, Looks) {
    DarkroomLook look = nullptr;
    std::string warned;
    auto options = sized<DarkroomLookOptions>();
    options.warn = [](void* user, const char* text) { *static_cast<std::string*>(user) += text; };
    options.user = &warned;
    ASSERT_EQ(
        darkroom_look_parse("[post_process]\nbloom_intensity = 0.3\nbloom_intensty = 1\n", "a.toml", &options, &look),
        DARKROOM_OK)
        << darkroom_error();
    EXPECT_NE(warned.find("a.toml:3"), std::string::npos) << warned;
    ASSERT_EQ(darkroom_look_override(look, "exposure", "2"), DARKROOM_OK) << darkroom_error();
    float exposure = 0;
    ASSERT_EQ(darkroom_look_exposure(look, &exposure), DARKROOM_OK);
    EXPECT_EQ(exposure, 2);
    const CStack stack;
    ASSERT_EQ(darkroom_look_apply(look, stack.composer, nullptr), DARKROOM_OK) << darkroom_error();
    DarkroomHandle bloom = 0;
    EXPECT_EQ(darkroom_composer_find(stack.composer, "bloom", &bloom), DARKROOM_OK);

    DarkroomLook other = nullptr;
    ASSERT_EQ(darkroom_look_parse(darkroom_look_write(look), "b.toml", nullptr, &other), DARKROOM_OK)
        << darkroom_error();
    EXPECT_EQ(std::string(darkroom_look_write(look)), darkroom_look_write(other));
    VkBool32 needs_compile = VK_TRUE;
    ASSERT_EQ(darkroom_look_override(other, "bloom_intensity", "0.4"), DARKROOM_OK);
    ASSERT_EQ(darkroom_look_follow(look, other, stack.composer, nullptr, &needs_compile), DARKROOM_OK);
    EXPECT_EQ(needs_compile, VK_FALSE);
    EXPECT_NE(darkroom_look_entry_name(other, 0), nullptr);
    EXPECT_EQ(darkroom_look_parse("[post_process", "c.toml", nullptr, &look), DARKROOM_ERROR_USER);
    EXPECT_EQ(std::string_view(darkroom_error()).find("darkroom_look_parse: c.toml:1"), 0u) << darkroom_error();
    darkroom_look_destroy(look);
    darkroom_look_destroy(other);
}

// Hot reload: a description that went leaves its place to another one.
TEST(CInterface, ACustomEffectIsWhatItIsAndNotWhatWasThereBefore) {
    const CStack stack;
    for (int i = 0; i < 8; ++i) {
        const std::string name = fmt::format("mine{}", i);
        const std::string text = fmt::format(
            "// @effect {0}: Number {1}.\n{2}vec4 {0}(vec4 color, Pixel pixel, Mine{1} parameters) {{ return color; "
            "}}\n",
            name, i, i % 2 != 0 ? "// @param float amount = 1 in [0, 1]: Amount.\n" : "");
        DarkroomCustomEffect custom = nullptr;
        ASSERT_EQ(darkroom_custom_effect_parse(text.c_str(), "mine.glsl", &custom), DARKROOM_OK) << darkroom_error();
        DarkroomHandle handle = 0;
        ASSERT_EQ(darkroom_composer_add_effect(stack.composer, darkroom_custom_effect_info(custom), nullptr, &handle),
                  DARKROOM_OK);
        darkroom_custom_effect_destroy(custom);
        DarkroomEffect effect = nullptr;
        ASSERT_EQ(darkroom_composer_info(stack.composer, handle, &effect), DARKROOM_OK);
        auto info = sized<DarkroomEffectInfo>();
        ASSERT_EQ(darkroom_effect_info(effect, &info), DARKROOM_OK);
        EXPECT_EQ(info.name, name);
        EXPECT_EQ(info.parameter_count, static_cast<std::uint32_t>(i % 2));
        ASSERT_EQ(darkroom_composer_remove(stack.composer, handle), DARKROOM_OK);
    }
}

TEST(CInterface, TheSizeOfTheFirstOfAnArrayIsThatOfAll) {
    const CStack stack;
    const DarkroomHandle bloom = stack.add("bloom");
    const auto half = std::bit_cast<std::uint32_t>(0.5f);
    std::array<DarkroomLayerValue, 2> values{};
    values[0] = {.struct_size = sizeof(DarkroomLayerValue), .word_count = 1, .entry = bloom, .parameter = "intensity"};
    values[1] = {.word_count = 1, .entry = bloom, .parameter = "opacity"};
    for (DarkroomLayerValue& value : values) value.words = &half;
    auto layer = sized<DarkroomLayerDesc>();
    layer.name = "soft";
    layer.value_count = values.size();
    layer.values = values.data();
    EXPECT_EQ(darkroom_composer_add_layer(stack.composer, &layer), DARKROOM_OK) << darkroom_error();
}

TEST(CInterface, ZeroIsMeantWhereItIsSaid) {
    const CStack stack;
    const DarkroomHandle vignette = stack.add("vignette");
    ASSERT_EQ(darkroom_composer_set_opacity(stack.composer, vignette, 0), DARKROOM_OK);
    auto desc = sized<DarkroomEntryDesc>();
    ASSERT_EQ(darkroom_composer_desc(stack.composer, vignette, &desc), DARKROOM_OK);
    ASSERT_EQ(darkroom_composer_rewire(stack.composer, vignette, &desc), DARKROOM_OK) << darkroom_error();
    ASSERT_EQ(darkroom_composer_desc(stack.composer, vignette, &desc), DARKROOM_OK);
    EXPECT_EQ(desc.opacity, 0);
    auto light = sized<DarkroomLight>();
    auto frame = sized<DarkroomFrame>();
    frame.light_count = 1;
    frame.lights = &light;
    for (const bool is_meant : {false, true}) {
        light.has_colors = is_meant;
        const auto read = c::frame_of(&frame, *stack.composer);
        ASSERT_TRUE(read) << read.error().text;
        const Light& made = read->lights[0];
        EXPECT_EQ(made.color, (is_meant ? std::array{0.0f, 0.0f, 0.0f} : std::array{1.0f, 1.0f, 1.0f}));
        EXPECT_EQ(made.volumetric_color, made.color);
    }
}

TEST(CInterface, APlanTellsAHostHowItsImagesAreUsed) {
    const CStack stack;
    stack.add("tonemap");
    const std::string json = stack.plan();
    const std::size_t color = json.find("{\"name\": \"color\"");
    ASSERT_NE(color, std::string::npos);
    const std::string line = json.substr(color, json.find('}', color) - color);
    EXPECT_NE(line.find("\"layout\": 5, \"final_layout\": 5"), std::string::npos) << line;
    EXPECT_NE(line.find("\"stages\": 128, "), std::string::npos) << "in a fragment shader: " << line;
    EXPECT_NE(line.find("\"access\": 4294967296, "), std::string::npos) << "sampled: " << line;
    DarkroomPlan coming = nullptr;
    EXPECT_EQ(darkroom_composer_coming_plan(stack.composer, &coming), DARKROOM_OK);
    EXPECT_EQ(coming, nullptr);
}

TEST(CInterface, WhatIsThrownIntoItStaysInside) {
    const auto thrown = [](const auto& error) { return c::call("f", [&]() -> Result<> { throw error; }); };
    expect_error(thrown(std::runtime_error("it broke")), "f: it broke", DARKROOM_ERROR_MACHINE);
    expect_error(thrown(std::bad_alloc()), "f: out of memory", DARKROOM_ERROR_OUT_OF_MEMORY);
    EXPECT_EQ(thrown(7), DARKROOM_ERROR_MACHINE);
}

}  // namespace
}  // namespace darkroom
