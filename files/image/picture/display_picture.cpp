// SPDX-License-Identifier: MIT
#include "image/picture/display_picture.hpp"

#include "image/color/convert_picture.hpp"

namespace darkroom {

namespace {

// To red, green, blue and alpha: one channel or two are grey, and what has no alpha is opaque wherever there are data.
Picture picture_of(const LayerSamples& samples, const FilePart& part) {
    Picture out(samples.width, samples.height);
    const bool is_gray = samples.channels < 3;
    const bool has_alpha = samples.channels == 2 || samples.channels == 4;
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const float* const in = &samples.values[(std::size_t{y} * out.width + x) * samples.channels];
            float* const pixel = out.at(x, y);
            for (std::uint32_t c = 0; c < 3; ++c) pixel[c] = in[is_gray ? 0 : c];
            const std::int64_t column = std::int64_t{x} - part.x, row = std::int64_t{y} - part.y;
            const bool is_inside = column >= 0 && row >= 0 && column < part.width && row < part.height;
            pixel[3] = has_alpha ? in[samples.channels - 1] : is_inside ? 1.0f : 0.0f;
        }
    return out;
}

}  // namespace

Result<ComparablePicture> read_comparable(const std::filesystem::path& path) {
    DARKROOM_TRY_VALUE(LayerFile file, LayerFile::open(path));
    Result<ComparablePicture> out = read_comparable(file);
    const std::string place = path.string() + ": ";
    if (!out && !out.error().text.starts_with(place)) out.error().text.insert(0, place);
    return out;
}

Result<ComparablePicture> read_comparable(LayerFile& file) {
    DARKROOM_TRY_VALUE(const FileLayer layer, file.find("color"));
    DARKROOM_TRY_VALUE(const LayerSamples samples, file.read(layer));
    if (samples.values.empty())
        return user_error("the color has 32-bit integers; numbers of at most 16 bits, half or float are read");
    const FilePart& part = file.decoder().parts()[layer.part];
    ComparablePicture out{.picture = picture_of(samples, part)};
    const SampleKind kind = part.kinds[layer.channels.front()];
    const auto [coding, warning, said] = file.decoder().color(layer.part);
    if (kind != SampleKind::Half && kind != SampleKind::Float) {
        out.coding = coding;
        out.color_said = said;
        return out;
    }
    out.encoding = PictureEncoding::SceneLinear;
    if (!coding || samples.channels < 3) return out;
    decode(out.picture, kind, coding->curve);
    const std::optional<ColorMatrix> matrix = to_rec709(coding->primaries);
    if (matrix && *matrix != ColorMatrix{1, 0, 0, 0, 1, 0, 0, 0, 1}) convert(out.picture, *matrix);
    return out;
}

}  // namespace darkroom
