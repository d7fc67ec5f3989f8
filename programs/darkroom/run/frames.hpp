// SPDX-License-Identifier: MIT
#pragma once
// Frames of files as the library's develop functions take them, and frames of a renderer as files.

#include <array>
#include <darkroom/look.hpp>
#include <set>
#include <string>
#include <vector>

#include "develop/developer.hpp"
#include "develop/reference_chain.hpp"
#include "image/frame/frame_file.hpp"
#include "image/frame/frame_set.hpp"
#include "image/frame/sequence.hpp"
#include "image/picture/picture.hpp"
#include "image/picture/write.hpp"
#include "timeline.hpp"

namespace app {

/// With the camera file of its number, where that is one of several.
[[nodiscard]] darkroom::Result<darkroom::FrameFile> read_frame(const darkroom::NumberedFile& file,
                                                               darkroom::FrameOptions options);
/// The frame's lights, with the depths of their cascades moved out of it. Where those stayed in the file, a light casts
/// no shadow.
[[nodiscard]] std::vector<darkroom::ReferenceLight> take_lights(darkroom::FrameFile& frame);
/// A warning, where the frame has depth and no projection: what develop_input() assumes. `shown` is the file.
void tell_of_assumed_view(const darkroom::FrameFile& frame, std::string_view shown);
/// Refers to the memory of both.
[[nodiscard]] darkroom::DevelopInput develop_input(const darkroom::FrameFile& frame,
                                                   std::span<const darkroom::ReferenceLight> lights);
/// What a file that is written from `layers` and read again gives take_lights and develop_input. `frame` says camera
/// and time.
[[nodiscard]] darkroom::FrameFile frame_file(const darkroom::Frame& frame, darkroom::FrameLayers layers);
/// The camera as develop_input would have it of a file with this one: what a file does not store is left behind.
[[nodiscard]] darkroom::Camera as_stored(const darkroom::Camera& camera);
/// Says of `frame` which layers a stack of this look reads. Gives how many frames before one its histories need, where
/// frames are `delta_time` seconds apart, at the worst of the moments of a timeline.
[[nodiscard]] darkroom::Result<std::uint32_t> add_needs(const darkroom::Look& look, double delta_time,
                                                        Timeline timeline, darkroom::FrameOptions& frame);
/// Switches off noise that nobody asked for where the picture has more than 8 bits, whose steps it hides, what encodes
/// for sRGB where the picture is for another space, and tone mapping where a view of a display has its own.
void suit(darkroom::Look& look, darkroom::DevelopTarget target, const darkroom::WriteOptions& options);
/// What a file with alpha holds: straight, and multiplied by it in a file of floats, which is an OpenEXR file.
[[nodiscard]] darkroom::ColorState with_alpha(const std::optional<darkroom::ColorState>& color,
                                              darkroom::DevelopTarget target, const darkroom::WriteOptions& options);
/// Refuses code values of another display than sRGB's where the files would say that they are sRGB's.
[[nodiscard]] darkroom::Result<> check_codes(const darkroom::Look& look, darkroom::DevelopTarget target,
                                             const darkroom::WriteOptions& options);
/// One warning, `frame` first, for each entry that is on and has no place in the plan, but for those that are on by
/// default. Gives how many that were.
std::size_t warn_of_what_is_left_out(const darkroom::Look& look, const darkroom::Composer& composer,
                                     std::span<const std::string> left_out, std::string_view frame = {});
/// From one input's number to the next, where none is missing: frames on twos are 2 apart.
[[nodiscard]] long long step_of(std::span<const darkroom::NumberedFile> inputs);

using FrameNumbers = std::set<long long>;
/// First and last of each that follow one another.
[[nodiscard]] std::vector<std::array<long long, 2>> ranges_of(const FrameNumbers& numbers);
/// "0-6, 9"; "none".
[[nodiscard]] std::string shown(const FrameNumbers& numbers);
/// Of numbers that `typed`, the value of --frames, asks for and no input has.
void warn_of_missing_inputs(std::string_view typed, const darkroom::FrameSet& frames,
                            std::span<const darkroom::NumberedFile> inputs);
/// A warning for each entry that stands where the picture is in another colour domain than it expects.
void warn_of_what_is_misplaced(const darkroom::Plan& plan);
/// By the CPU references alone, in the form that the target asks for. `histories`: of the frame before, then of this
/// one. `left_out`: as in Plan.
[[nodiscard]] darkroom::Result<darkroom::DevelopedPicture> develop_by_reference(const darkroom::Composer& composer,
                                                                                const darkroom::DevelopInput& input,
                                                                                const darkroom::DevelopDesc& desc,
                                                                                darkroom::ReferenceHistories& histories,
                                                                                std::vector<std::string>& left_out);
/// A warning, where floats are asked for and their compression keeps less.
void tell_of_half_range(const darkroom::WriteOptions& options);
[[nodiscard]] darkroom::Result<> write(const std::filesystem::path& path, darkroom::DevelopedPicture picture,
                                       const darkroom::WriteOptions& options);

}  // namespace app
