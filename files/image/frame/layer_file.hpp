// SPDX-License-Identifier: MIT
#pragma once
// The layers of an image file with their numbers as they are: NaN and infinity stay what they are, nothing is decoded,
// turned or converted. For those who judge files; frames, in which all of that is mended, are in frame_file.hpp.

#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/codec/decoder.hpp"

namespace darkroom {

/// Channels of one part that belong together.
struct FileLayer {
    /// "color", "depth", "normals" or "velocity" for those that a frame is made of, else `file_name`.
    std::string name;
    std::string file_name;  ///< what the file calls it: "ViewLayer.Depth", "N"; empty for plain R, G, B
    std::size_t part = 0;
    std::vector<std::uint32_t> channels;  ///< of the part
};

/// The samples of a layer: rows from the top, `channels` a pixel, as large as the display window; 0 outside of the
/// data.
struct LayerSamples {
    std::uint32_t width = 0, height = 0, channels = 0;
    std::vector<float> values;
    std::vector<std::uint32_t> integers;  ///< in place of `values`, of a layer of 32-bit integers
};

/// The range of some samples, and how many are not finite.
struct SampleRange {
    /// Of the finite ones; without any, least is above most.
    double least = std::numeric_limits<double>::infinity(), most = -std::numeric_limits<double>::infinity();
    std::uint64_t nan = 0, infinite = 0;

    [[nodiscard]] bool has_finite() const { return least <= most; }
    template <class Sample>
    void add(std::span<const Sample> samples, std::size_t stride);
    void add(const SampleRange& other);
};

/// An opened file. The texts of its errors begin with the path.
class LayerFile {
  public:
    [[nodiscard]] static Result<LayerFile> open(const std::filesystem::path& path);

    [[nodiscard]] const Decoder& decoder() const { return decoder_; }
    /// Every channel of the file is in one of them: first those of a frame, if there is a colour, then the others in
    /// the order of the file.
    [[nodiscard]] std::span<const FileLayer> layers() const { return layers_; }
    /// By `name`, by `file_name`, "motion" for velocity, or one channel by its full name.
    [[nodiscard]] Result<FileLayer> find(std::string_view name) const;
    [[nodiscard]] std::vector<std::string> channel_names(const FileLayer& layer) const;
    /// Its channels of 32-bit integers, of which a float holds 24 bits, or its others.
    [[nodiscard]] FileLayer of_kind(const FileLayer& layer, bool is_wide_integer) const;
    /// Refused: 32-bit integers beside other numbers.
    [[nodiscard]] Result<LayerSamples> read(const FileLayer& layer);
    /// One for each channel of the part, over its data window.
    [[nodiscard]] Result<std::vector<SampleRange>> ranges(std::size_t part);

  private:
    LayerFile(std::string path, Decoder decoder) : path_(std::move(path)), decoder_(std::move(decoder)) {}
    [[nodiscard]] Failure error(std::string_view text) const;
    void list_layers();
    template <class Sample>
    [[nodiscard]] Result<> read_samples(const FileLayer& layer, LayerSamples& out, std::vector<Sample>& to);

    std::string path_;
    Decoder decoder_;
    std::vector<FileLayer> layers_;
    std::string why_no_frame_;
};

}  // namespace darkroom
