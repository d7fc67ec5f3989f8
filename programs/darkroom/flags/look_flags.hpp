// SPDX-License-Identifier: MIT
#pragma once
// The flags that say what is done to the picture: the look, its order, and one flag for every parameter of every
// effect, made from the effects' descriptions.

#include <darkroom/look.hpp>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "flags.hpp"
#include "looks/look_parts.hpp"

namespace app {

// Files that were read, so that nothing is written over them.

/// From any thread: a window reads looks while it draws.
class ReadFiles {
  public:
    /// False: it was read before.
    bool add(const std::filesystem::path& file) {
        const std::lock_guard lock(adding_);
        return files_.insert(file).second;
    }
    [[nodiscard]] std::vector<std::filesystem::path> all() const {
        const std::lock_guard lock(adding_);
        return {files_.begin(), files_.end()};
    }

  private:
    mutable std::mutex adding_;
    std::set<std::filesystem::path> files_;
};

/// Scenes hold a look beside other tables; what has another name is a look alone, and unknown tables are slips.
[[nodiscard]] bool is_scene_name(const std::filesystem::path& path);

/// Makes the files of a look's interface, which are relative to `folder`, such that they can be opened.
void resolve_ui(darkroom::Look& look, const std::filesystem::path& folder);

class LookFlags {
  public:
    /// `has_look_flag`: false where the look is a positional argument. `named`: effects of files.
    void add_to(CommandFlags command, bool has_look_flag, std::span<const darkroom::LookEntry> named);
    /// Reads the look and applies the flags. Prints warnings. Without a file of its own it is that of the scene. The
    /// document of its interface is as it can be opened. `lens`: of the camera that it is for.
    [[nodiscard]] darkroom::Result<darkroom::Look> look(const std::filesystem::path& scene = {},
                                                        const darkroom::CameraLens& lens = {}) const;
    /// The same for frames of files, whose light nobody knows: without a file, default_look_of_traced_light().
    [[nodiscard]] darkroom::Result<darkroom::Look> look_of_frames() const;
    /// How it reads the files of looks. `warnings` outlives what is returned.
    [[nodiscard]] darkroom::LookOptions options(std::vector<std::string>* warnings) const;
    /// What the flags say of any look: what look() does to the one that it has read. Those that are off keep their
    /// place where it is asked for. --ui becomes the interface's document as it was typed.
    [[nodiscard]] darkroom::Result<> change(darkroom::Look& look, bool keeps_what_is_off) const;
    [[nodiscard]] bool change_anything() const;
    /// What they read: the look, its layers, the timeline, and the tables and pictures of looks that were read so far.
    [[nodiscard]] std::vector<std::filesystem::path> input_files() const;
    [[nodiscard]] const std::string& ui_file() const { return ui_file_; }
    /// --no-postprocess. look() is then switched off.
    [[nodiscard]] bool is_off() const { return is_off_; }
    [[nodiscard]] bool is_strict() const { return is_strict_; }

    std::string file;
    std::string events;  ///< of a timeline, for which what is off keeps its place; empty: none

  private:
    struct Value {
        std::string key;
        std::string flag;
        std::string text;
        Flag option;
    };
    void add_effect(CommandFlags command, const darkroom::EffectInfo& effect);
    Value& add_value(std::string key, std::string flag);
    /// `value`: what it takes, as help shows it.
    void add_flag(CommandFlags command, const std::string& key, const std::string& value, const std::string& help,
                  const std::string& group);
    /// --bloom and --no-bloom.
    void add_switch(CommandFlags command, const darkroom::EffectInfo& effect, const std::string& group);
    [[nodiscard]] darkroom::Result<std::vector<darkroom::LookOverride>> overrides() const;
    /// Puts those of --effect behind the look's entries, at their defaults.
    [[nodiscard]] darkroom::Result<> add_custom_effects(darkroom::Look& look) const;
    [[nodiscard]] darkroom::Result<darkroom::Look> look(const std::filesystem::path& path,
                                                        const darkroom::Look& without_path,
                                                        const darkroom::CameraLens& lens) const;
    [[nodiscard]] darkroom::Result<> lay_layers(darkroom::Look& look) const;
    [[nodiscard]] darkroom::Result<> set_order(darkroom::Look& look) const;
    [[nodiscard]] darkroom::Result<> set_ui(darkroom::Look& look) const;

    std::string order_, ui_file_;
    std::vector<std::string> layers_, sets_, effect_files_, game_;
    std::vector<std::unique_ptr<Value>> values_;                       // CLI11 keeps references to the texts
    std::shared_ptr<ReadFiles> read_ = std::make_shared<ReadFiles>();  ///< by the looks that options() are for
    std::optional<CommandFlags> command_;                              // knows in which order they were typed
    bool is_strict_ = false;
    bool has_no_custom_effects_ = false;
    bool is_off_ = false;
};

}  // namespace app
