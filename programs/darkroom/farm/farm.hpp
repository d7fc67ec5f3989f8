// SPDX-License-Identifier: MIT
#pragma once
// What a farm is asked for: a sequence to be developed or a scene to be rendered, as `develop` and `render` have it,
// which do the work. Their own flags stand behind "--" and are handed on as they are.

#include <darkroom/look.hpp>
#include <darkroom/result.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "farm_record.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/flags/flags.hpp"
#include "programs/darkroom/flags/run_flags.hpp"

namespace app {

// The commands below `farm`, which add themselves to it.

[[nodiscard]] Command add_farm_slurm(CommandFlags farm, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_farm_task(CommandFlags farm, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_farm_status(CommandFlags farm);

struct FarmFrame {
    long long number = 0;
    std::filesystem::path picture;
};

struct FarmWork {
    std::vector<FarmFrame> frames;  ///< in the order of their numbers
    FarmNames names;
    std::filesystem::path folder;  ///< of its records
    bool is_range = true;          ///< false: between the first and the last there are some that are not asked for
};

/// Where nothing was submitted yet, pictures of these names were made with nobody knows which look.
[[nodiscard]] darkroom::Result<> check_unknown_pictures(const FarmWork& work);

class FarmFlags {
  public:
    void add_to(CommandFlags command, const std::string& frames_doc);
    /// Errors: no sequence and no scene, no frame, no such folder.
    [[nodiscard]] darkroom::Result<FarmWork> work() const;
    /// All that `develop` or `render` would refuse before it reads a frame or a scene, of flags and look. Gives what
    /// these were read from; models and their textures are not looked at.
    [[nodiscard]] darkroom::Result<FarmInputs> check(const FarmWork& work,
                                                     std::span<const darkroom::LookEntry> named) const;
    /// Of the command that makes these frames: "develop", and so on.
    [[nodiscard]] std::vector<std::string> command(const std::string& frames) const;
    /// Of `farm task`, without --frames and its value, which go before these.
    [[nodiscard]] std::vector<std::string> task() const;
    [[nodiscard]] const std::string& frames() const { return frames_; }

  private:
    [[nodiscard]] bool is_scene() const;
    [[nodiscard]] darkroom::Result<> check_arguments() const;
    [[nodiscard]] darkroom::Result<std::vector<FarmFrame>> frames_in(
        const std::optional<darkroom::FrameSet>& frames) const;

    std::string input_, out_, look_, frames_;
    std::vector<std::string> more_;
    [[nodiscard]] MissingFolders missing_folders() const {
        return makes_folder_ ? MissingFolders::Made : MissingFolders::Told;
    }
    [[nodiscard]] bool is_folder() const { return is_output_folder(out_, missing_folders()); }

    bool allows_custom_effects_ = false, makes_folder_ = false;
};

}  // namespace app
