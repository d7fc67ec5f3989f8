// SPDX-License-Identifier: MIT
// docs/formats.md: what each format keeps of a picture, by writing and reading it in every depth and compression. What
// our decoders read of a file OpenImageIO reads, too.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "core/srgb.hpp"
#include "image/codec/codecs.hpp"
#include "image/color/output_space.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/alpha.hpp"
#include "image/picture/write.hpp"
#include "image/test_files.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

std::string name_of_file(const FileFormat& format) { return fmt::format("a{}", format.extensions.front()); }

bool is_written(const FileFormat& format, const WriteOptions& options) {
    return sample_kind(name_of_file(format), options).has_value();
}

constexpr std::array depths{SampleKind::Integer8, SampleKind::Integer16, SampleKind::Half, SampleKind::Float};
constexpr const char* page_name = "/docs/formats.md";

class ImageFormats : public WithFolder {
  protected:
    /// What comes back of numbers as files have them: code values, or light.
    Picture back(const FileFormat& format, const Picture& picture, const WriteOptions& options) {
        const std::filesystem::path path = file(name_of_file(format));
        const Result<> done = write_picture(path, picture, options);
        EXPECT_TRUE(done) << done.error().text;
        auto frame = read_frame(path);
        EXPECT_TRUE(frame) << frame.error().text;
        if (!frame) return picture;
        compare_with_openimageio(path, *frame);
        if (options.alpha && !frame->is_associated) associate(frame->color);
        if (is_integer(*sample_kind(path, options)))
            for (std::size_t i = 0; i < frame->color.pixels.size(); ++i)
                if (i % 4 < 3) frame->color.pixels[i] = srgb_encode(frame->color.pixels[i]);
        return std::move(frame->color);
    }

    /// The file's samples by the other library, row by row.
    void compare_with_openimageio(const std::filesystem::path& path, const FrameFile& frame) {
        const auto bytes = read_file(path);
        ASSERT_TRUE(bytes);
        const auto found = format_of_file(*bytes);
        ASSERT_TRUE(found);
        const FileFormat& format = **found;
        if (format.openimageio.empty()) return;  // has a test of its own by another program
        const auto library = codecs();
        ASSERT_TRUE(library) << library.error().text;
        const auto source = (*library)->open(format, *bytes);
        ASSERT_TRUE(source) << source.error().text;
        const FilePart& part = (*source)->parts()[0];
        ASSERT_EQ(part.width, frame.color.width);
        ASSERT_EQ(part.height, frame.color.height);
        const std::size_t channels = part.channels.size(), row = std::size_t{part.width} * channels;
        std::vector<float> theirs(row * part.height);
        std::vector<SamplePlace> places;
        for (std::size_t c = 0; c < channels; ++c)
            places.push_back({.channel = c,
                              .first = reinterpret_cast<std::byte*>(theirs.data() + c),
                              .pixel_bytes = static_cast<std::ptrdiff_t>(channels * sizeof(float)),
                              .row_bytes = static_cast<std::ptrdiff_t>(row * sizeof(float))});
        ASSERT_TRUE((*source)->read_rows(0, 0, part.height, places));
        for (std::size_t i = 0; i < theirs.size(); ++i) {
            const std::size_t c = i % channels;
            const float ours = frame.color.pixels[i / channels * 4 + c];
            const float expected = is_integer(part.kinds[c]) && c < 3 ? srgb_decode(theirs[i]) : theirs[i];
            // They take a mantissa of Radiance for m / 256; of JPEG each has a cosine transform of its own.
            const float allowed =
                format.name == "JPEG" ? 0.02f : (format.name == "Radiance HDR" ? 5e-3f : 1e-6f) * std::abs(expected);
            ASSERT_NEAR(ours, expected, std::max(allowed, 1e-6f)) << format.name << " " << i;
        }
    }

    /// A picture of one colour.
    static Picture grey(float value, float alpha = 1) {
        Picture out(9, 8);
        for (std::size_t i = 0; i < out.pixels.size(); ++i) out.pixels[i] = i % 4 == 3 ? alpha : value;
        return out;
    }

    std::string alpha_of(const FileFormat& format, SampleKind kind) {
        WriteOptions options{.samples = kind, .alpha = true};
        if (!sample_kind(file(name_of_file(format)), options)) return "none";
        const float kept = back(format, grey(0.5f, 0.25f), options).pixels[3];
        EXPECT_NEAR(kept, 0.25f, 0.002f) << format.name;
        // Light over nothing: what is straight has no place for it.
        return back(format, grey(0.5f, 0), options).pixels[0] > 0 ? "multiplied" : "straight";
    }

    /// The largest number that comes back within a hundredth.
    std::string most_of(const FileFormat& format, SampleKind kind) {
        std::string out = "0";
        for (const auto& [value, shown] :
             {std::pair(1.0f, "1"), std::pair(65504.0f, "65504"), std::pair(1e6f, "1e6"), std::pair(1e38f, "1e38")})
            if (std::abs(back(format, grey(value), {.samples = kind}).pixels[0] / value - 1) < 0.01f) out = shown;
        return out;
    }

    /// Of smooth light between a quarter and one: how many bits of a number are right.
    std::string bits_of(const FileFormat& format, SampleKind kind, const std::string& compression = {}) {
        Picture ramp(64, 64);
        for (std::size_t i = 3; i < ramp.pixels.size(); i += 4) ramp.pixels[i] = 1;
        for (std::uint32_t y = 0; y < 64; ++y)
            for (std::uint32_t x = 0; x < 64; ++x)
                for (std::uint32_t c = 0; c < 3; ++c)
                    ramp.at(x, y)[c] = 0.25f + 0.74f * static_cast<float>(x * 64 + y + c * 7) / 4110;
        const Picture found = back(format, ramp, {.samples = kind, .compression = compression});
        double worst = 0;
        for (std::size_t i = 0; i < ramp.pixels.size(); ++i) {
            const double off = std::abs(double{found.pixels[i]} - ramp.pixels[i]);
            worst = std::max(worst, is_integer(kind) ? off : off / ramp.pixels[i]);
        }
        if (worst == 0) return "24";
        // Rounded codes are half a step off, numbers half of their last bit.
        return fmt::format("{:.0f}", std::floor(-std::log2(worst) - (is_integer(kind) ? 0.9 : 0) + 1e-3));
    }

    /// Noise comes back as it was at no compression, and at this one?
    bool is_lossless(const FileFormat& format, SampleKind kind, std::string_view compression) {
        Picture noise(70, 40);
        std::mt19937 random(3);
        for (float& value : noise.pixels) value = static_cast<float>(random()) * 0x1p-32f;
        const auto with = [&](std::string_view name) {
            return back(
                format, noise,
                {.samples = kind, .alpha = is_written(format, {.alpha = true}), .compression = std::string(name)});
        };
        return with(compression) == with(format.compressions.front());
    }

    static std::string spaces_of(const FileFormat& format, SampleKind kind) {
        std::vector<std::string> out;
        for (const std::string_view name : {"srgb", "p3", "rec2020", "pq", "hlg"})
            if (sample_kind(name_of_file(format), {.samples = kind, .space = *find_output_space(name)}))
                out.push_back(name == "srgb" && !is_integer(kind) ? "Rec. 709" : fmt::format("`{}`", name));
        return fmt::format("{}", fmt::join(out, " "));
    }

    std::string page() {
        std::string out =
            "# Formats of pictures\n\n"
            "For example, `darkroom develop frame.exr -o out.tif --bits 16` writes a TIFF of 16 bits. A file is read "
            "by how\n"
            "its bytes begin, whatever its name, and written by its extension. "
            "[Frames](conventions.md#frames-as-files)\n"
            "says how colours and alpha are read. The test `ImageFormats.ThePageIsWhatRoundTripsGive` makes this "
            "page:\n"
            "it writes and reads every depth and compression, and reads each file by OpenImageIO, too.\n\n"
            "| Format | Files | Written, by `--bits` |\n|---|---|---|\n";
        const auto shown = [](SampleKind kind) {
            return is_integer(kind) ? fmt::format("{}", 8 * size_of(kind)) : std::string(name_of(kind));
        };
        for (const FileFormat* const row : all_formats()) {
            const FileFormat& format = *row;
            std::vector<std::string> kinds;
            for (const SampleKind kind : depths)
                if (is_written(format, {.samples = kind})) kinds.push_back(shown(kind));
            out += fmt::format("| {} | `{}` | {} |\n", format.name, fmt::join(format.extensions, "` `"),
                               kinds.empty() ? "read alone" : fmt::format("{}", fmt::join(kinds, ", ")));
        }
        out +=
            "\n## Of several pictures\n"
            "\n"
            "One is read, and a warning says how many there are and which it is; `info` has it, too.\n"
            "\n"
            "| Format | What is read |\n"
            "|---|---|\n"
            "| OpenEXR | the parts of a frame ([names](conventions.md#names-that-are-recognised)); of tiles the "
            "largest level |\n"
            "| JPEG | the first, and a gain map (ISO 21496-1, Ultra HDR) as light; one of Apple's is told and not applied |\n"
            "| PNG | the picture, which may be an animation's first frame |\n"
            "| TIFF | the first page that is no smaller copy of another (`NewSubfileType`), or that a copy names "
            "(`SubIFDs`) |\n"
            "| WebP | an animation is refused |\n"
            "\n## What comes back\n\n"
            "Integers hold code values of a display, floats hold light. Alpha: none; straight; or colours multiplied "
            "by\n"
            "it, which alone keep light where alpha is 0. From and to: the numbers that the file holds, others are "
            "clamped.\n"
            "Bits: of a code, or of a float's size, that are right in smooth colours. Spaces: `--output-space`.\n"
            "A mantissa m of Radiance HDR is (m + 0.5) / 256, as Radiance and libvips have it; OpenImageIO, OpenCV and\n"
            "Blender 5.0 have m / 256, half a step darker. What others make of each file is [a page of its own]"
            "(readers.md).\n\n"
            "| Format | `--bits` | Alpha | From | To | Bits | Spaces that it can be marked as "
            "|\n|---|---|---|---|---|---|---|\n";
        for (const FileFormat* const row : all_formats())
            for (const SampleKind kind : depths) {
                const FileFormat& format = *row;
                if (!is_written(format, {.samples = kind})) continue;
                const float below = back(format, grey(-2), {.samples = kind}).pixels[0];
                const std::string most = most_of(format, kind);
                out += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", format.name, shown(kind),
                                   alpha_of(format, kind), below == -2 ? "-" + most : "0", most, bits_of(format, kind),
                                   spaces_of(format, kind));
            }
        out +=
            "\n## Compressions\n\n"
            "By `--compression`; the first list gives every bit back, the second does not. What `--keep-layers` keeps "
            "is\n"
            "never changed: it gets a part of its own beside a picture of the second. JPEG changes numbers by "
            "`--quality`.\n\n"
            "| Format | `--bits` | Lossless | Changes numbers |\n|---|---|---|---|\n";
        for (const FileFormat* const row : all_formats())
            for (const SampleKind kind : depths) {
                const FileFormat& format = *row;
                if (!is_written(format, {.samples = kind}) || format.compressions.empty()) continue;
                std::vector<std::string> same, other;
                for (const std::string_view name : format.compressions)
                    (is_lossless(format, kind, name) ? same : other).push_back(fmt::format("`{}`", name));
                const auto list = [](const std::vector<std::string>& names) {
                    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, " "));
                };
                out += fmt::format("| {} | {} | {} | {} |\n", format.name, shown(kind), list(same), list(other));
            }
        return out;
    }
};

TEST_F(ImageFormats, ThePageIsWhatRoundTripsGive) {
    const std::string made = page(), path = test::source_folder + std::string(page_name);
    // See docs/changing.md.
    if (std::getenv("DARKROOM_RENEW_PAGES") != nullptr) put(path, made);
    EXPECT_EQ(content(path), made);
}

}  // namespace
}  // namespace darkroom
