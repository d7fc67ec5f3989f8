// SPDX-License-Identifier: MIT
#pragma once
// A look that is being edited: what it is now, what it was, and the file that it goes back into. It holds no device and
// draws nothing: a Composer is taken along with darkroom::follow, panels and consoles change it with the functions of
// edit/edits.hpp.

#include <chrono>
#include <cstdint>
#include <darkroom/look.hpp>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/files.hpp"
#include "looks/camera_lens.hpp"

namespace darkroom::edit {

/// Tells when files are others than when it was last asked.
class Watch {
  public:
    using Clock = std::chrono::system_clock;
    /// `read`: when reading it began. What was saved since is a change.
    void add(const std::filesystem::path& file, Clock::time_point read = Clock::now());
    /// Takes a file as it is now.
    void take(const std::filesystem::path& file) { files_[file] = stamp_of(file); }
    /// Those that are others than they were, which are then taken as they are now. One that is gone counts as unchanged
    /// until it is there again: editors replace files.
    [[nodiscard]] std::vector<std::filesystem::path> take_changes();
    [[nodiscard]] bool take_change() { return !take_changes().empty(); }

  private:
    std::map<std::filesystem::path, FileStamp> files_;
};

class LookDocument {
  public:
    static constexpr std::size_t max_steps = 1000;
    static constexpr std::size_t max_history_bytes = std::size_t{256} << 20;  ///< tables that only it holds included

    /// Of a look or a scene. `lens`: of the camera that the look is for, which says what the file does not; a scene's
    /// own camera says it by itself. Errors are read_look's.
    [[nodiscard]] static Result<LookDocument> open(const std::filesystem::path& file, LookOptions options,
                                                   const CameraLens& lens = {});
    /// Of no file yet.
    explicit LookDocument(Look look = default_look(), LookOptions options = {});

    [[nodiscard]] const Look& look() const { return look_; }
    /// Another number after every change of the look.
    [[nodiscard]] std::uint64_t version() const { return version_; }
    /// What the file says; without a file, what the document began with.
    [[nodiscard]] const Look& saved_look() const { return saved_; }
    /// How files are read that the look names. Its folder is the document's.
    [[nodiscard]] const LookOptions& options() const { return options_; }

    /// One step of undo. `change` works on a copy: where it fails, or makes a look that cannot be, nothing happened.
    /// Steps with the same `merge`, unless it is empty, are one until end_merge(): a slider that is dragged.
    Result<> edit(std::string what, const std::function<Result<>(Look&)>& change, std::string_view merge = {});
    void end_merge() { merge_.clear(); }

    [[nodiscard]] bool can_undo() const { return !undo_.empty(); }
    [[nodiscard]] bool can_redo() const { return !redo_.empty(); }
    /// What undo() takes back, and redo() does again; empty: nothing.
    [[nodiscard]] std::string_view undo_name() const;
    [[nodiscard]] std::string_view redo_name() const;
    /// Without a step they do nothing.
    void undo();
    void redo();

    /// Does the look differ from what its file says?
    [[nodiscard]] bool is_changed() const { return is_changed_; }
    /// Empty: there is none.
    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    /// Writes what changed into the text that was read, all else as it stands there: whatever was saved in between, the
    /// same look gives the same bytes. Errors: there is no file; it has been changed by others since; something cannot
    /// be written there. The file is then as it was.
    Result<> save();
    /// The same into another file, which becomes the document's, and is overwritten. In another folder it is that of a
    /// look, whatever the document's was. Errors: the look names files, which are relative to the folder that it is in.
    Result<> save_as(const std::filesystem::path& file);
    /// What save() would write; without a file, a look's file. Errors are save()'s.
    [[nodiscard]] Result<std::string> unsaved_text() const;
    /// The look that such a text says, as a step of undo. Errors: those of the text.
    Result<> take_unsaved(std::string_view text);
    /// Reads what has changed on disk: the file, or one that the look names. True: the look is another, as a step of
    /// undo; but an effect is the one that its file holds now on both sides of every step. An error, "file:line:column:
    /// ...", leaves it, and comes once for each state of the files.
    Result<bool> reload_if_changed();
    /// The look is for another camera: what the file does not write and nobody has changed is as that one says, at
    /// every step of undo, too.
    void follow_lens(const CameraLens& lens);
    /// Did the last reading of a change fail?
    [[nodiscard]] bool is_broken() const { return is_broken_; }
    /// What the reading of the file passed over, "file:line:column: ...".
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
    /// The files that the last change on disk was in.
    [[nodiscard]] const std::vector<std::filesystem::path>& changed_files() const { return changed_files_; }

  private:
    struct Step {
        std::string what;
        Look look;  ///< on the other side of the step
        std::size_t bytes = 0;
    };

    void take(Look look);
    void remember(std::string what);
    void give_ids(Look& look);
    Result<> check(const Look& next) const;
    void watch_files(Watch::Clock::time_point read = Watch::Clock::now());
    Result<bool> reload();
    /// Entries of files' effects are of those that the files hold now, and keep the values that both have.
    void keep_effects(Look& look, const Look& now) const;
    /// `is_spliced`: into the text that was read; else all is written anew.
    Result<> write(const std::filesystem::path& file, bool is_spliced);
    Result<Look> read(std::string_view text, const Look& ids_of);
    /// A look's file that says what differs from the defaults; where a flat table cannot, all of it.
    [[nodiscard]] std::string new_text() const;

    std::filesystem::path file_;
    LookOptions options_;
    CameraLens lens_;
    std::string text_;  ///< of the file, as it was read or written last
    /// The text that others wrote last, and its look: what is saved is spliced into that, not into what was saved
    /// before, so that a way back through the steps is one through the bytes, too.
    std::string read_text_;
    Look read_;
    Look saved_, look_;
    std::uint64_t version_ = 1;
    std::uint64_t last_id_ = 0;
    std::deque<Step> undo_, redo_;
    std::string merge_;
    bool is_changed_ = false, is_broken_ = false;
    std::vector<std::string> warnings_;
    std::vector<std::filesystem::path> changed_files_;
    Watch watch_;
};

}  // namespace darkroom::edit
