// SPDX-License-Identifier: MIT
#pragma once
// Chooses a file, to open or to save: folders and files of some kinds, by mouse or keyboard (letters filter, arrows
// move, Enter takes, Backspace goes up, Escape gives up). It reads folders and touches no file.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace darkroom::panels {

struct FileRequest {
    std::string title;                    ///< "Save the look as"
    std::filesystem::path start;          ///< a folder, or a file in it; empty: the working directory
    std::vector<std::string> extensions;  ///< with their dots, lower case; empty: all files
    bool is_saving = false;               ///< the file need not be there; one that is there is asked about
    std::function<void(const std::filesystem::path&)> then;  ///< called at most once, with an absolute path
};

class FileBrowser {
  public:
    static constexpr std::size_t max_entries = 20000;  ///< of a folder; more are not shown

    /// In the place of a request that is open.
    void open(FileRequest request);
    [[nodiscard]] bool is_open() const { return is_open_; }
    /// Once a frame, outside of any window.
    void draw();

    struct Entry {
        std::string shown;
        std::filesystem::path path;
        bool is_folder = false;
    };
    /// Of the present folder: folders first, by name, without what begins with a dot.
    [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  private:
    void enter(const std::filesystem::path& folder);
    void take(const std::filesystem::path& file);
    void choose(std::size_t index);
    void draw_head();
    void draw_list(float height);
    void draw_foot();
    [[nodiscard]] std::vector<std::size_t> visible() const;
    void press_keys(const std::vector<std::size_t>& seen);
    void accept();
    /// A name in the folder, or a path that is relative to it.
    [[nodiscard]] std::filesystem::path typed(const std::string& name) const;

    FileRequest request_;
    bool is_open_ = false, is_new_ = false, shows_all_ = false, is_replacing_ = false, is_cut_short_ = false;
    std::filesystem::path folder_;
    std::vector<Entry> entries_;
    std::string problem_, filter_, name_;
    std::size_t present_ = 0;   ///< among those that are visible
    bool follows_ = false;      ///< the list scrolls to it
    bool wants_focus_ = false;  ///< the field that is typed into
};

}  // namespace darkroom::panels
