// SPDX-License-Identifier: MIT
#include "frames.hpp"

namespace app {

using darkroom::DevelopedPicture;
using darkroom::DevelopInput;
using darkroom::DevelopTarget;
using darkroom::ReferenceImage;
using darkroom::Result;

namespace {

ReferenceImage reference_image(std::span<const float> values, VkExtent2D extent, std::size_t channels) {
    ReferenceImage out(extent.width, extent.height);
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        std::array<double, 4> texel{0, 0, 0, 1};
        for (std::size_t c = 0; c < channels; ++c) texel[c] = values[i * channels + c];
        out.pixels[i] = {texel[0], texel[1], texel[2], texel[3]};
    }
    return out;
}

}  // namespace

DevelopInput develop_input(const darkroom::FrameFile& frame) {
    DevelopInput input{.extent = {frame.color.width, frame.color.height}, .color = frame.color.pixels};
    if (frame.depth) input.depth = frame.depth->values;
    if (frame.normals) input.normals = frame.normals->values;
    if (frame.velocity) input.velocity = frame.velocity->values;
    input.camera.depth = darkroom::DepthKind::Planar;
    if (frame.camera.world_to_camera) input.camera.view = *frame.camera.world_to_camera;
    if (frame.camera.projection) input.camera.projection = *frame.camera.projection;
    input.camera.previous_view = input.camera.view;
    input.camera.previous_projection = input.camera.projection;
    return input;
}

Result<DevelopedPicture> develop_by_reference(const darkroom::Composer& composer, const DevelopInput& input,
                                              DevelopTarget target) {
    const ReferenceImage color = reference_image(input.color, input.extent, 4);
    const auto layer = [&](std::span<const float> values, std::size_t channels) {
        return values.empty() ? ReferenceImage() : reference_image(values, input.extent, channels);
    };
    const ReferenceImage depth = layer(input.depth, 1), normals = layer(input.normals, 3),
                         velocity = layer(input.velocity, 2);
    const auto given = [](const ReferenceImage& image) { return image.pixels.empty() ? nullptr : &image; };
    const darkroom::Domain domain =
        target == DevelopTarget::SceneLinear ? darkroom::Domain::SceneLinear : darkroom::Domain::Encoded;
    const Result<darkroom::ReferenceChainOutput> made =
        darkroom::run_reference(composer, {.color = &color,
                                           .depth = given(depth),
                                           .normals = given(normals),
                                           .velocity = given(velocity),
                                           .camera = input.camera,
                                           .time = input.time,
                                           .frame_index = input.frame_index,
                                           .target_domain = domain});
    if (!made) return failure(made.error());
    DevelopedPicture out{.extent = {made->picture.width, made->picture.height}};
    if (target == DevelopTarget::Encoded8) {
        out.bytes = darkroom::round_to_bytes(made->picture);
        return out;
    }
    out.pixels.reserve(made->picture.pixels.size() * 4);
    for (const darkroom::Rgba& pixel : made->picture.pixels)
        for (const double channel : {pixel.r, pixel.g, pixel.b, pixel.a})
            out.pixels.push_back(static_cast<float>(channel));
    return out;
}

Result<> write(const std::filesystem::path& path, DevelopedPicture picture, const darkroom::WriteOptions& options) {
    const auto [width, height] = picture.extent;
    if (!picture.bytes.empty()) return darkroom::write_bytes(path, width, height, picture.bytes, options);
    darkroom::Picture out;
    out.width = width;
    out.height = height;
    out.pixels = std::move(picture.pixels);
    return darkroom::write_picture(path, out, options);
}

}  // namespace app
