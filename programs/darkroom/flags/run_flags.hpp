// SPDX-License-Identifier: MIT
#pragma once
// The flags of commands that make many pictures: what kind of files they are, and how the work is spread.

#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "flags.hpp"
#include "image/frame/frame_set.hpp"
#include "image/picture/write.hpp"
#include "ocio_flags.hpp"
#include "programs/darkroom/run/outputs.hpp"

namespace app {

/// --output-space and --output-peak.
class SpaceFlags {
  public:
    void add_to(CommandFlags command, const std::string& group);
    [[nodiscard]] darkroom::Result<std::optional<darkroom::OutputSpace>> space() const;
    [[nodiscard]] bool is_given() const { return name_.has_value(); }

  private:
    std::optional<std::string> name_;
    NumberFlag peak_{"--output-peak", {.least = 100, .most = 10000, .unit = "cd/m2"}};
};

/// --bits, --alpha, --output-space, --output-peak, --compression, --quality, --format, and those of OcioFlags.
class WriteFlags {
  public:
    void add_to(CommandFlags command);
    /// `input_space`: see OcioFlags::view.
    [[nodiscard]] darkroom::Result<darkroom::WriteOptions> options(const std::string& input_space = {}) const;
    /// What `out` asks for if it is standard output, else nothing. Errors: it and --format must go together, other
    /// flags of files say nothing of a stream, and a terminal shows no pictures.
    [[nodiscard]] darkroom::Result<std::optional<StreamDesc>> stream(const std::string& out,
                                                                     double frames_per_second) const;

    OcioFlags ocio;

  private:
    std::optional<std::string> bits_, format_;
    SpaceFlags space_;
    [[nodiscard]] bool has_alpha() const { return !alpha_.empty() && alpha_ != "false"; }

    std::string alpha_, chroma_, compression_;
    NumberFlag quality_{"--quality", {.least = 1, .most = 100, .is_whole = true}};
};

inline constexpr std::size_t max_frames = 100'000;  ///< that are asked for at once

/// What --frames takes: see FrameSet. At most `max_frames`.
[[nodiscard]] darkroom::Result<darkroom::FrameSet> parse_frames(const std::string& text);

/// --jobs, --skip-existing, --keep-going, --mkdir, --progress, --timings.
class RunFlags {
  public:
    void add_to(CommandFlags command);
    /// 0: as many as there are processors.
    [[nodiscard]] darkroom::Result<std::size_t> jobs() const;
    /// Is this file there and not empty, and should it stay?
    [[nodiscard]] bool is_skipped(const std::filesystem::path& output) const;
    /// Says how many were, where there are some.
    static void tell_of_skipped(std::size_t skipped, std::size_t asked_for);
    /// Standard output has no pictures that are there already, and no place for one that is missing.
    [[nodiscard]] darkroom::Result<> check_stream() const;
    /// What --mkdir says.
    [[nodiscard]] MissingFolders missing_folders() const {
        return makes_folders_ ? MissingFolders::Made : MissingFolders::Told;
    }
    /// From here on the work is reported as --progress says.
    [[nodiscard]] darkroom::Result<> start_report() const;

    bool keeps_going = false, has_timings = false;

  private:
    std::optional<std::string> progress_;
    NumberFlag jobs_{"--jobs", {.least = 1, .most = 256, .is_whole = true}};
    bool skips_existing_ = false, makes_folders_ = false;
};

}  // namespace app
