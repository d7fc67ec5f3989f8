// SPDX-License-Identifier: MIT
#pragma once
// Internal to edit/viewer: what a viewer is made of, for viewer.cpp (the frames), viewer_keys.cpp (what keys do) and
// viewer_files.cpp (what is stored and read again).

#include <chrono>
#include <deque>
#include <future>
#include <system_error>
#include <type_traits>

#include "draw_scale.hpp"
#include "edit/document.hpp"
#include "gui.hpp"
#include "inspection.hpp"
#include "journal.hpp"
#include "playback.hpp"
#include "screen.hpp"
#include "store.hpp"
#include "viewer.hpp"
#include "viewer/input/camera_rig.hpp"
#include "viewer/input/command_line.hpp"
#include "viewer/input/keys.hpp"
#include "viewer/panels/panel_layout.hpp"
#include "viewer/source/compared_picture.hpp"
#include "viewer/source/live_interface.hpp"
#include "viewer/source/look_view.hpp"
#include "viewer/source/thumbnails.hpp"

namespace app {

class Viewer {
  public:
    explicit Viewer(ViewerJob job) : job_(std::move(job)) {}
    ~Viewer();

    [[nodiscard]] darkroom::Result<> run();
    [[nodiscard]] int exit_code(int code) const;

  private:
    using Clock = std::chrono::steady_clock;

    // viewer.cpp
    [[nodiscard]] darkroom::Result<> open();
    [[nodiscard]] bool is_high_range() const;
    [[nodiscard]] darkroom::Result<> start_interface();
    [[nodiscard]] darkroom::Result<> turn();
    [[nodiscard]] darkroom::Result<> show(const darkroom::window::PresentFrame& frame);
    void draw_screen(const darkroom::window::PresentFrame& frame);
    void move_time(double passed);
    [[nodiscard]] LiveMoment moment() const;
    [[nodiscard]] darkroom::Result<LookView*> view(Side side);
    [[nodiscard]] VkExtent2D picture_extent() const;
    /// Is a picture shown through a look that is switched off? A scene without an interface draws its own then.
    [[nodiscard]] bool is_off() const { return !is_post_on_ && (scene_ == nullptr || interface_->is_given()); }
    [[nodiscard]] bool is_fixed() const { return job_.frames_to_show.has_value(); }
    [[nodiscard]] darkroom::Look look_of(Side side) const;

    // viewer_record.cpp
    [[nodiscard]] darkroom::Result<> prepare(const darkroom::window::PresentFrame& frame, VkExtent2D extent);
    [[nodiscard]] darkroom::Result<> record(const darkroom::window::PresentFrame& frame);
    [[nodiscard]] std::array<bool, side_count> shown_sides() const;
    [[nodiscard]] darkroom::Result<> record_look(VkCommandBuffer commands, Side side, const darkroom::Frame& frame);

    // viewer_device.cpp
    /// The device, what shows pictures with it, and the source.
    [[nodiscard]] darkroom::Result<> open_device();
    [[nodiscard]] darkroom::Result<> make_device();
    /// What the source is seen through.
    [[nodiscard]] darkroom::Result<> open_views();
    /// A device that was lost takes all along that was made with it: what its user has done stays.
    [[nodiscard]] darkroom::Result<> make_anew(const darkroom::Error& error);
    void let_go_of_device();

    // viewer_keys.cpp
    void obey_keys();
    /// Is the mouse the camera's? Where a button went down decides until it is up, and not the panels of the frame
    /// before, which know an older place.
    [[nodiscard]] bool is_mouse_of_camera();
    void obey(KeyAction action, std::uint32_t function_key);
    void toggle_effects(std::uint32_t function_key);
    void obey_camera(KeyAction action);
    void toggle_pause();
    void step_frame(long frames);
    /// At the second time, where something would be lost.
    void leave();
    void run_command(const std::string& command);
    void obey_input();
    /// What the console prints.
    void print(std::string line);
    /// In the window, and on standard output.
    void tell(std::string line);
    void list_places();
    void open_place(const darkroom::panels::TextPlace& place);
    [[nodiscard]] std::string_view camera_word() const;
    /// Reports what went wrong with `source`, or clears what it said before.
    void settle(std::string_view source, const darkroom::Result<>& done) {
        done ? screen_.clear_error(source) : screen_.tell_error(source, done.error().text);
    }
    /// Work beside the frames, such as reading and writing files, on a thread of its own; without one the window waits,
    /// and says so.
    template <class Work>
    [[nodiscard]] auto start_beside(const Work& work) {
        try {
            auto out = std::async(std::launch::async, work);
            settle("threads", {});
            return out;
        } catch (const std::system_error&) {
            settle("threads", darkroom::machine_error("no further thread can be started: the window waits while files "
                                                      "are read and written"));
        }
        std::packaged_task<std::invoke_result_t<Work>()> here(work);
        auto out = here.get_future();
        here();
        return out;
    }

    // viewer_seeing.cpp
    [[nodiscard]] darkroom::Result<> watch();
    [[nodiscard]] darkroom::Result<> inspect(VkCommandBuffer commands, const darkroom::Frame& frame);
    [[nodiscard]] darkroom::Result<> read_scopes(const darkroom::window::PresentFrame& frame);
    void finish_seeing();
    void show_thumbnails(const darkroom::window::PresentFrame& frame);
    [[nodiscard]] darkroom::panels::Thumbnail thumbnail_of(const Thumbnails::Subject& subject);

    // viewer_source.cpp
    /// Another scene, or frames, in place of those that are shown.
    struct Opened {
        std::filesystem::path file;
        std::unique_ptr<SceneSource> scene;
        std::vector<darkroom::NumberedFile> files;
        std::unique_ptr<FrameSource> frames;
    };
    [[nodiscard]] darkroom::Result<> make_source();
    void take_scene(std::unique_ptr<SceneSource> scene);
    [[nodiscard]] darkroom::CameraLens lens() const;
    void follow_lens();
    void take_frames(std::unique_ptr<FrameSource> frames);
    void watch_source(darkroom::edit::Watch::Clock::time_point read);
    void reload_source();
    void open_subject(const std::filesystem::path& file);
    /// To compare with: a look, or a picture, which is read beside the frames.
    void take_other(const std::filesystem::path& file);
    /// Of files, from any thread: for the camera as it is now.
    [[nodiscard]] std::function<darkroom::Result<darkroom::Look>(const std::filesystem::path& file)> look_reader()
        const;
    void take_other_look(const std::filesystem::path& look);
    void take_other_picture();
    void fire(const std::string& event);
    void take_opened();
    void name_window();

    // viewer_pace.cpp
    /// Waits where there was nothing to draw, and takes what has happened meanwhile.
    void rest();
    [[nodiscard]] bool is_due();
    [[nodiscard]] bool is_time_running() const;
    /// Is there something to draw that comes by itself, such as a plan?
    [[nodiscard]] bool is_coming() const;
    [[nodiscard]] double frames_a_second();

    [[nodiscard]] DrawScale::Turn draw_turn() const;
    /// Is the picture made of several frames of the scene, each drawn from another place within the pixel?
    [[nodiscard]] bool gathers() const;
    [[nodiscard]] darkroom::render::FrameJitter jitter() const;
    /// Has nothing changed that the picture is made of, the plan apart?
    [[nodiscard]] bool is_picture_kept() const;
    [[nodiscard]] bool is_looked_into() const;

    // viewer_files.cpp
    void reload();
    void follow_document();
    void tell_warnings();
    void tell_source_warnings();
    [[nodiscard]] bool has_config() const;
    /// Empty: there is none.
    [[nodiscard]] static std::filesystem::path config_folder();
    [[nodiscard]] static std::filesystem::path config_file();
    [[nodiscard]] bool keeps_panels() const;
    /// Panels lie as they did in a window of this size.
    void recall_panels();
    void remember_panels();
    void offer_unsaved();
    void write_journal();
    [[nodiscard]] darkroom::Result<> read_config();
    void write_config();
    void store_picture(const darkroom::window::PresentFrame& frame);
    void tell_store(const darkroom::Result<>& done);
    void finish_stores(bool waits);

    ViewerJob job_;
    std::optional<darkroom::window::Window> window_;
    std::unique_ptr<darkroom::Device> device_;
    std::optional<darkroom::window::Presenter> presenter_;
    std::unique_ptr<LiveSource> source_;
    SceneSource* scene_ = nullptr;  ///< the source, if it is one
    std::optional<darkroom::edit::LookDocument> document_;
    darkroom::Look other_look_;                     ///< to compare with
    std::optional<ComparedPicture> other_picture_;  ///< in its place
    std::filesystem::path other_file_;              ///< of that picture
    std::future<darkroom::Result<darkroom::ComparablePicture>> other_coming_;
    std::uint64_t followed_ = 0;  ///< version of the document that is on the screen
    std::array<std::unique_ptr<LookView>, side_count> views_;
    std::unique_ptr<LiveInterface> interface_;
    std::unique_ptr<Gui> gui_;
    Screen screen_;
    std::optional<Journal> journal_;  ///< of edit
    std::optional<KnownPanels> known_panels_;
    VkExtent2D panels_of_{};  ///< the window whose panels are shown
    std::optional<CameraRig> camera_;
    std::optional<darkroom::scene::Ground> ground_;  ///< that is walked on

    darkroom::render::DrawOptions draw_;
    Clock::time_point busy_until_{};  ///< its user has just done something
    std::deque<Clock::time_point> shown_at_;
    std::uint32_t frames_due_ = 0;
    std::uint64_t drawn_version_ = 0;  ///< of the document
    bool is_resting_ = false, is_echo_ = false, has_measured_ = false;
    DrawScale scale_;
    bool is_led_ = false;                              ///< a hand has just moved the camera
    bool is_button_down_ = false, has_mouse_ = false;  ///< in the frame before; see is_mouse_of_camera()
    VkExtent2D full_extent_{};                         ///< of the whole picture
    VkExtent2D made_extent_{};                         ///< of the picture that is made
    std::optional<std::array<float, 2>> last_jitter_;  ///< of the scene's frame before
    std::uint64_t developed_version_ = 0;              ///< of the document
    bool has_rested_ = true, has_developed_ = false;   ///< before the frame that comes; since then a look was recorded
    double passed_ = 0;                                ///< seconds since the frame before
    bool is_post_on_ = true, is_paused_ = false, is_leaving_ = false;
    double time_ = 0, previous_time_ = 0, delta_time_ = 0;
    Playback playback_;  ///< of a sequence
    Clock::time_point last_turn_ = Clock::now(), last_look_at_files_ = Clock::now();
    std::optional<darkroom::scene::OrbitOverride> last_orbit_;
    darkroom::edit::Watch source_files_;
    std::future<darkroom::Result<std::unique_ptr<SceneSource>>> coming_;  ///< the scene, read again
    std::future<darkroom::Result<Opened>> opening_;
    darkroom::edit::Watch::Clock::time_point reading_since_;  ///< that of either
    std::filesystem::path opens_next_;                        ///< asked for meanwhile
    std::filesystem::path saved_as_;                          ///< the document's file, when it was last looked at
    std::string titled_;                                      ///< what the window is called by
    std::vector<std::string> source_warnings_;
    std::pair<std::string, std::vector<std::string>> interface_files_;  ///< document and controllers, as it started
    LineInput input_;
    std::optional<std::string> places_;                  ///< widgets that were asked for, by how their names begin
    Clock::time_point sure_until_{};                     ///< who leaves again before then means it
    std::uint64_t shown_frames_ = 0, frame_number_ = 0;  ///< so far; of the one that is recorded, in the presenter
    std::uint64_t frame_index_ = 0;                      ///< as Frame has it: stands still with the time
    bool is_cut_ = true;

    std::unique_ptr<Thumbnails> thumbnails_;
    std::optional<std::uint64_t> thumbnails_frame_;  ///< whose copy is on its way to them
    bool has_thumbnails_ = false;                    ///< somebody looks at them
    std::deque<Clock::time_point> lost_at_;          ///< devices, lately

    FrameInspection inspection_;
    Store store_;
    std::string failed_;  ///< the last store that failed
};

}  // namespace app
