/* SPDX-License-Identifier: MIT */
#ifndef DARKROOM_H
#define DARKROOM_H
// Darkroom for C, and for every language that can call C: an ordered stack of effects that turns a host's HDR frame into
// a finished picture inside the host's own command buffer. docs/c.md begins with an example, examples/embed.c is a whole
// host.
//
//     DarkroomEntryDesc entry = {sizeof entry};
//     DarkroomHandle bloom;
//     darkroom_composer_add(composer, "bloom", &entry, &bloom);
//     darkroom_composer_set_number(composer, bloom, "intensity", 0.08);
//     darkroom_composer_add(composer, "tonemap", NULL, NULL);
//
// The law of every function, where it says nothing else itself.
//
// Structs
//   Each begins with its own size (struct_size), so that it may grow at its end; of an array the first one's size is that
//   of all. Everything else may be zero: zero is the default, said where it is not obvious. A larger struct than the
//   library knows is taken if what is beyond is zero.
//   Of an array that the library fills, `count` is the room before the call, and how many there are after it.
// Who frees
//   An object that a call gives (DarkroomDevice, Composer, Plan, Look, CustomEffect, KernelFile, HudInertia) is the
//   caller's, and ended once by the darkroom_..._destroy() of its kind; null does nothing there. An effect is not ended.
//   Objects go in any order, because each keeps what it needs of another. A composer goes when the GPU has finished all of
//   its recordings.
//   Texts and arrays that a call gives are the library's, and valid until the next call with the same object; those of an
//   effect as long as it. Nothing is freed by the caller.
//   What a call gets is read during the call and copied; it may go when the call returns. Kept are the Vulkan objects of
//   DarkroomAdoptDesc, its `allocator`, and its callbacks with their `user`: they outlive the device and all that was made
//   on it. The images of a frame outlive its recording. The library ends none of the host's objects.
// What is an error, and not a crash
//   A function that can fail returns a DarkroomResult; darkroom_error() is its text. What it was to return is then as it
//   was. Errors are: a null object or pointer where one is needed, a struct of another size, an
//   enum's number that is none, a name, handle or parameter that is not there or no longer, a value out of its range, an
//   image that is not as the stack was compiled, a feature that the host's device lacks, a file that is wrong, no memory.
//   No exception leaves a function. Where the library finds a mistake of its own, and there alone, it writes one line to
//   standard error and ends the process (abort).
//   Not seen, and undefined: an object that was ended, a pointer to something else, a text without its 0, less room than
//   `count` says, a handle of Vulkan that is none, a format or feature that is otherwise than said, a command buffer that
//   is not being recorded, recordings that are submitted twice, in another order or to several queues, more unfinished
//   recordings than frames_in_flight * views, and what breaks the rules of threads and callbacks.
// Threads
//   Functions without an object: any thread, at any time. A device and an effect: several threads at once.
//   Any other object: one thread at a time, whichever that is; several threads may use several composers of one device.
//   To end an object, no other thread may be in a call with it. darkroom_error() is each thread's own.
//   The library never waits for the GPU in record, and touches no queue of the host's: to submit is the host's.
// Callbacks
//   `warn` and `load_resource` are called by the thread that is in the call; the log and `allocate` and `free` as they
//   say, by threads of the library, too. None may throw, longjmp out, or wait for a thread that is in a call.
// Texts are UTF-8 and end with 0.

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

#if defined(_WIN32) && defined(DARKROOM_BUILDS)
#define DARKROOM_API __declspec(dllexport)
#elif defined(_WIN32)
#define DARKROOM_API __declspec(dllimport)
#elif defined(__GNUC__)
#define DARKROOM_API __attribute__((visibility("default")))
#else
#define DARKROOM_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/// The version that a program was compiled for, as darkroom_version() has it.
#define DARKROOM_VERSION 1000

/// Who has to act, and what a host may act on.
typedef enum DarkroomResult {
    DARKROOM_OK = 0,
    DARKROOM_ERROR_USER = 1,           ///< a file, a value or a stack is wrong
    DARKROOM_ERROR_MACHINE = 2,        ///< a call of Vulkan or of the system failed
    DARKROOM_ERROR_DEVICE_LOST = 3,    ///< the host makes its device anew: darkroom_composer_rebind
    DARKROOM_ERROR_OUT_OF_MEMORY = 4,
    DARKROOM_ERROR_UNSUPPORTED = 5     ///< the device, or this build of the library, cannot do it
} DarkroomResult;

typedef struct DarkroomDeviceObject* DarkroomDevice;
typedef struct DarkroomComposerObject* DarkroomComposer;
typedef struct DarkroomPlanObject* DarkroomPlan;
typedef struct DarkroomLookObject* DarkroomLook;
typedef struct DarkroomCustomEffectObject* DarkroomCustomEffect;
typedef struct DarkroomKernelFileObject* DarkroomKernelFile;
typedef struct DarkroomHudInertiaObject* DarkroomHudInertia;
/// A kind of effect. Those of the library live as long as it, those of a file as long as their DarkroomCustomEffect.
typedef const struct DarkroomEffectObject* DarkroomEffect;

/// An entry of a stack, and its output as an input for others. 0: the output of the entry before.
typedef uint64_t DarkroomHandle;
/// The scene colour as the host gives it.
#define DARKROOM_SCENE_COLOR UINT64_C(4294967295)
/// The alpha of the scene colour as a grey picture.
#define DARKROOM_SCENE_ALPHA UINT64_C(4294967294)
/// The interface's image: encoded, premultiplied.
#define DARKROOM_UI_LAYER UINT64_C(4294967293)

/// A parameter of one entry of one composer, found once: what darkroom_composer_set_float and its like take.
typedef uint64_t DarkroomParameter;

// ---------------------------------------------------------------------------------------------------------------------
// The library

/// The version of the library that was loaded: major * 1000000 + minor * 1000 + patch.
DARKROOM_API uint32_t darkroom_version(void);
/// The error of the last call of this thread that failed, one line: place, thing, value, what is allowed. Valid until
/// the next call of this thread that fails.
DARKROOM_API const char* darkroom_error(void);

// ---------------------------------------------------------------------------------------------------------------------
// Devices

/// How much a message matters.
typedef enum DarkroomSeverity {
    DARKROOM_SEVERITY_DEBUG = 0,
    DARKROOM_SEVERITY_INFO = 1,
    DARKROOM_SEVERITY_WARNING = 2,
    DARKROOM_SEVERITY_ERROR = 3
} DarkroomSeverity;
/// Takes a message. Called from whichever thread has something to say, for one device by one at a time.
typedef void (*DarkroomLog)(void* user, DarkroomSeverity severity, const char* text);

/// What kind of device kernels are made for ahead of time.
typedef enum DarkroomDeviceProfile {
    DARKROOM_DEVICE_PROFILE_GPU = 0,
    DARKROOM_DEVICE_PROFILE_SOFTWARE = 1  ///< a driver that runs on the CPU
} DarkroomDeviceProfile;

/// What darkroom_device_list and darkroom_device_info tell.
typedef struct DarkroomDeviceInfo {
    uint32_t struct_size;
    uint32_t index;
    uint32_t api_version;
    VkBool32 is_software;  ///< a CPU driver
    VkBool32 is_null;      ///< its driver compiles for hardware that is not there, and runs nothing
    VkBool32 is_usable;
    char name[256];
    char driver[256];
    char reason[512];  ///< why it is not usable
} DarkroomDeviceInfo;

/// What a headless device is made with.
typedef struct DarkroomDeviceDesc {
    uint32_t struct_size;
    VkBool32 compiles_only;     ///< for darkroom_composer_statistics alone: null devices are taken too
    VkBool32 validate;          ///< Khronos validation layer with synchronization validation
    VkBool32 no_caches;         ///< no file is read or written
    const char* select;         ///< index, or name or a part of it; null: a real GPU if there is one
    const char* cache_folder;   ///< of SPIR-V and pipeline caches; null: the user's
    DarkroomLog log;
    void* log_user;
    const void* kernels;        ///< of darkroom_kernel_file_bytes or `darkroom bake`; copied
    size_t kernels_size;        ///< bytes
    const char* const* instance_extensions;  ///< enabled beside the library's own
    const char* const* device_extensions;
    uint32_t instance_extension_count;
    uint32_t device_extension_count;
} DarkroomDeviceDesc;

/// A piece of device memory that the library needs.
typedef struct DarkroomMemoryRequest {
    uint32_t struct_size;
    uint32_t memory_type;  ///< the best one that will do; after an error the library asks for the next
    VkDeviceSize size;
    VkDeviceSize alignment;
    VkImage image;    ///< the one image or buffer that it is for; both null where several share it
    VkBuffer buffer;
    VkBool32 is_mapped;           ///< the type is host-visible and coherent; DarkroomMemory::mapped has to be set
    VkBool32 prefers_dedicated;
    VkBool32 requires_dedicated;  ///< VkMemoryDedicatedRequirements
} DarkroomMemoryRequest;
/// A piece of device memory that a host gives: a range of an allocation, which may hold others.
typedef struct DarkroomMemory {
    uint32_t struct_size;
    VkDeviceMemory memory;
    VkDeviceSize offset;  ///< a multiple of the alignment that was asked for
    void* mapped;         ///< where `offset` is, until the piece is freed
    void* owner;          ///< the host's own, such as a VmaAllocation
} DarkroomMemory;
/// Fills in a piece of memory. Called by whoever compiles, edits or destroys, from several threads where several do.
typedef VkResult (*DarkroomAllocate)(void* user, VkDevice device, const DarkroomMemoryRequest* request,
                                     DarkroomMemory* memory);
/// Takes a piece of memory back.
typedef void (*DarkroomFree)(void* user, VkDevice device, const DarkroomMemory* memory);

/// A device that the host has made. Vulkan cannot be asked what was enabled, so the host says it.
typedef struct DarkroomAdoptDesc {
    uint32_t struct_size;
    uint32_t queue_family;
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    PFN_vkGetInstanceProcAddr get_proc;
    const VkPhysicalDeviceFeatures2* enabled_features;  ///< and their pNext chain, as given to vkCreateDevice
    const char* const* enabled_instance_extensions;  ///< with VK_EXT_debug_utils passes and objects get names
    const char* const* enabled_device_extensions;    ///< read on Vulkan 1.2 only
    uint32_t enabled_instance_extension_count;
    uint32_t enabled_device_extension_count;
    uint32_t api_version;  ///< VkApplicationInfo::apiVersion; 0: VK_API_VERSION_1_3
    VkBool32 no_caches;    ///< no file is read or written
    const char* cache_folder;
    DarkroomLog log;
    void* log_user;
    const void* kernels;
    size_t kernels_size;
    VkPipelineCache pipeline_cache;          ///< used instead of one of the library's; not externally synchronized
    const VkAllocationCallbacks* allocator;  ///< kept by pointer: it outlives the device and all that was made on it
    DarkroomAllocate allocate;               ///< this and `free`, or none
    DarkroomFree free;
    void* memory_user;
} DarkroomAdoptDesc;

/// All Vulkan devices of this machine, best first. `count` is the room in `infos`, and becomes what there are; `infos`
/// may be null.
DARKROOM_API DarkroomResult darkroom_device_list(DarkroomDeviceInfo* infos, uint32_t* count);
/// Creates a headless device. `desc` may be null.
DARKROOM_API DarkroomResult darkroom_device_create(const DarkroomDeviceDesc* desc, DarkroomDevice* device);
/// No device: what an ordinary one of this kind can do, for who plans stacks or bakes kernels.
DARKROOM_API DarkroomResult darkroom_device_assumed(DarkroomDeviceProfile profile, DarkroomDevice* device);
/// Takes the host's, and owns nothing of it. Errors name every missing feature, extension and queue capability.
DARKROOM_API DarkroomResult darkroom_device_adopt(const DarkroomAdoptDesc* desc, DarkroomDevice* device);
/// Composers of the device share what they need of it: it may go first.
DARKROOM_API void darkroom_device_destroy(DarkroomDevice device);
/// What the device is.
DARKROOM_API DarkroomResult darkroom_device_info(DarkroomDevice device, DarkroomDeviceInfo* info);
/// Messages of the validation layer so far.
DARKROOM_API DarkroomResult darkroom_device_validation_messages(DarkroomDevice device, uint64_t* count);

// ---------------------------------------------------------------------------------------------------------------------
// Effects

/// What a parameter is made of.
typedef enum DarkroomKind {
    DARKROOM_KIND_FLOAT = 0,
    DARKROOM_KIND_INT = 1,
    DARKROOM_KIND_TOGGLE = 2,
    DARKROOM_KIND_CHOICE = 3,
    DARKROOM_KIND_VEC2 = 4,
    DARKROOM_KIND_VEC3 = 5,
    DARKROOM_KIND_VEC4 = 6,
    DARKROOM_KIND_RGB = 7,      ///< linear Rec. 709
    DARKROOM_KIND_CURVE = 8,    ///< a count, 16 abscissae, 16 ordinates
    DARKROOM_KIND_RESOURCE = 9  ///< the number of a table or picture that was defined; 0: none
} DarkroomKind;

/// What darkroom_effect_info tells.
typedef struct DarkroomEffectInfo {
    uint32_t struct_size;
    uint32_t parameter_count;
    uint32_t word_count;   ///< of all its parameters, 4 bytes each
    VkBool32 is_ui;        ///< of the interface's own chain
    VkBool32 has_second;   ///< reads a second picture
    VkBool32 makes_output; ///< an upscaler
    const char* name;      ///< snake_case
    const char* doc;       ///< one sentence
    const char* page;      ///< its page, in Markdown; empty for those of a file
} DarkroomEffectInfo;

/// What darkroom_effect_parameter tells.
typedef struct DarkroomParameterInfo {
    uint32_t struct_size;
    DarkroomKind kind;
    const char* name;
    const char* doc;   ///< a sentence
    const char* unit;  ///< "px", "cd/m2", "m", "1/m", "deg", "s", "x", or empty
    double min;        ///< of its range; both 0: it has none
    double max;
    VkBool32 is_logarithmic;  ///< a slider of it goes in equal ratios
    VkBool32 is_amount;       ///< 0 switches the effect off
    VkBool32 is_at_compile;   ///< a change takes full effect with the next compile
    uint32_t word;            ///< offset among the effect's words
    uint32_t word_count;
    const uint32_t* default_words;
    const char* const* choices;  ///< names, of a choice
    uint32_t choice_count;
} DarkroomParameterInfo;

/// How many effects this build has; darkroom_effect_at() has them by name.
DARKROOM_API uint32_t darkroom_effect_count(void);
/// Null: there are fewer.
DARKROOM_API DarkroomEffect darkroom_effect_at(uint32_t index);
/// Null: there is none of that name.
DARKROOM_API DarkroomEffect darkroom_effect_find(const char* name);
/// What the effect is.
DARKROOM_API DarkroomResult darkroom_effect_info(DarkroomEffect effect, DarkroomEffectInfo* info);
/// One of its parameters, in the order of DarkroomEffectInfo::parameter_count.
DARKROOM_API DarkroomResult darkroom_effect_parameter(DarkroomEffect effect, uint32_t index,
                                                      DarkroomParameterInfo* info);

/// An effect of a user's, in one file of GLSL (docs/custom_effects.md). It may go before the composers that hold it.
DARKROOM_API DarkroomResult darkroom_custom_effect_load(const char* file, DarkroomCustomEffect* custom);
/// `shown_name` stands for the file in errors.
DARKROOM_API DarkroomResult darkroom_custom_effect_parse(const char* text, const char* shown_name,
                                                         DarkroomCustomEffect* custom);
/// Composers that hold the effect keep what they need of it.
DARKROOM_API void darkroom_custom_effect_destroy(DarkroomCustomEffect custom);
/// Null: `custom` is.
DARKROOM_API DarkroomEffect darkroom_custom_effect_info(DarkroomCustomEffect custom);

// ---------------------------------------------------------------------------------------------------------------------
// Frames

/// What the numbers of the picture are.
typedef enum DarkroomDomain {
    DARKROOM_DOMAIN_SCENE_LINEAR = 0,
    DARKROOM_DOMAIN_DISPLAY_LINEAR = 1,
    DARKROOM_DOMAIN_ENCODED = 2
} DarkroomDomain;
/// All with a white of D65.
typedef enum DarkroomPrimaries {
    DARKROOM_PRIMARIES_REC709 = 0,
    DARKROOM_PRIMARIES_REC2020 = 1,
    DARKROOM_PRIMARIES_P3 = 2
} DarkroomPrimaries;
/// From light to numbers.
typedef enum DarkroomTransfer {
    DARKROOM_TRANSFER_LINEAR = 0,
    DARKROOM_TRANSFER_SRGB = 1,
    DARKROOM_TRANSFER_GAMMA22 = 2,
    DARKROOM_TRANSFER_PQ = 3,
    DARKROOM_TRANSFER_HLG = 4,
    DARKROOM_TRANSFER_SCRGB = 5
} DarkroomTransfer;
/// What the numbers of a picture mean: darkroom/color_state.hpp.
typedef struct DarkroomColorState {
    uint32_t struct_size;
    DarkroomDomain domain;
    DarkroomPrimaries primaries;
    DarkroomTransfer transfer;
    float white_nits;  ///< of a diffuse white; 0: 203
    float peak_nits;   ///< of the brightest that it holds; 0: there is no end
    VkBool32 is_associated;  ///< its numbers were multiplied by alpha
} DarkroomColorState;

/// An image of the host's, as it is when the recorded commands start. Single-sampled.
typedef struct DarkroomImage {
    uint32_t struct_size;
    uint32_t mip_level;    ///< that the view shows
    VkImage image;
    VkImageView view;      ///< one mip level, one layer, colour or depth aspect
    VkFormat format;
    VkExtent2D extent;     ///< of the whole mip level that the view shows
    VkRect2D region;       ///< the part that holds the picture; extent (0, 0): all of it
    uint32_t array_layer;  ///< first layer that the view shows
    uint32_t layer_count;  ///< that the view shows; 0: 1
    VkImageLayout layout;  ///< that it is in; UNDEFINED only for a target, whose texels go
    VkImageLayout final_layout;  ///< how to leave it; UNDEFINED: as it came
    /// Of the host's last use. Both 0: all commands, memory writes.
    VkPipelineStageFlags2 last_stages;
    VkAccessFlags2 last_access;
    /// Of the host's next use. Both 0: all commands, memory reads and writes.
    VkPipelineStageFlags2 final_stages;
    VkAccessFlags2 final_access;
    VkBool32 has_barrier_before;  ///< the host has placed one, for what the plan's JSON tells of the image
    VkBool32 has_barrier_after;   ///< the host places one
} DarkroomImage;

/// What the numbers of a depth image mean.
typedef enum DarkroomDepthKind {
    DARKROOM_DEPTH_STANDARD = 0,  ///< device depth, 0 near .. 1 far
    DARKROOM_DEPTH_REVERSED = 1,  ///< device depth, 1 near .. 0 far
    DARKROOM_DEPTH_PLANAR = 2     ///< distance along the view axis, in scene units; 1e9 and more is sky
} DarkroomDepthKind;
/// Of the vectors in a velocity image.
typedef enum DarkroomVelocitySign {
    DARKROOM_VELOCITY_PREVIOUS_MINUS_CURRENT = 0,
    DARKROOM_VELOCITY_CURRENT_MINUS_PREVIOUS = 1
} DarkroomVelocitySign;
/// What they are measured in.
typedef enum DarkroomVelocityUnit {
    DARKROOM_VELOCITY_PIXELS = 0,
    DARKROOM_VELOCITY_UV = 1,  ///< the picture is 1 wide and 1 high
    DARKROOM_VELOCITY_NDC = 2  ///< the picture is 2 wide and 2 high
} DarkroomVelocityUnit;

/// Camera conventions are data. Matrices are column-major and applied to column vectors; all 0: the identity.
typedef struct DarkroomCamera {
    uint32_t struct_size;
    DarkroomDepthKind depth;
    float view[16];        ///< world to camera; the camera looks along -z, y up
    float projection[16];  ///< camera to clip space, with jitter
    float previous_view[16];
    float previous_projection[16];
    float near_distance;  ///< 0: 0.1
    float far_distance;   ///< 0: 1000; may be infinite
    VkBool32 is_y_up;     ///< of clip space: a flipped viewport
    DarkroomVelocitySign velocity_sign;
    DarkroomVelocityUnit velocity_unit;
    VkBool32 is_velocity_y_up;
    VkBool32 velocity_has_jitter;  ///< made from the jittered projections
    float jitter[2];           ///< how far the projection moves this frame's picture, in pixels, y down
    float previous_jitter[2];
    VkBool32 is_cut;      ///< nothing of the last frame is related to this one: histories are reset
    float jump_distance;  ///< of a move that is taken for a cut, in scene units; 0: 30; may be infinite
    float jump_angle;     ///< radians; 0: 60 degrees; may be infinite
} DarkroomCamera;

/// One directional light of the frame, with its shadow cascades where it casts.
typedef struct DarkroomLight {
    uint32_t struct_size;
    uint32_t cascade_count;     ///< at most 4; 0: casts no shadow
    float direction[3];         ///< toward the light, world space; 0: up
    float color[3];             ///< linear Rec. 709, times intensity; all 0 without has_colors: white
    float volumetric_color[3];  ///< all 0 without has_colors: white
    float volumetric_intensity;
    float splits[4];              ///< far distance of each cascade, along the view axis
    float world_to_cascade[64];   ///< four matrices: to x, y in [-1, 1] (y down) and depth in [0, 1]; all 0: identity
    const DarkroomImage* cascades;  ///< D32_SFLOAT array of squares, a layer a cascade
    VkBool32 has_colors;            ///< colours that are all 0 are meant
} DarkroomLight;

/// What a frame wants of a watch of DarkroomCompileDesc.
typedef struct DarkroomWatched {
    uint32_t struct_size;
    uint32_t id;                  ///< DarkroomWatch::id
    VkRect2D region;              ///< of the frame's picture that is shown, in pixels; extent (0, 0): all of it
    const DarkroomImage* target;  ///< gets the nearest texels, their numbers as they are
} DarkroomWatched;

/// One frame of one view. Images that are null are not given.
typedef struct DarkroomFrame {
    uint32_t struct_size;
    uint32_t view;                      ///< whose histories: below DarkroomCompileDesc::views
    const DarkroomImage* color;         ///< scene-linear Rec. 709
    const DarkroomImage* target;
    const DarkroomImage* depth;
    const DarkroomImage* normals;       ///< world space, -1 .. 1
    const DarkroomImage* velocity;      ///< as DarkroomCamera says
    const DarkroomImage* ui;            ///< sRGB-encoded, premultiplied after encoding
    const DarkroomImage* reactive;      ///< red: how little earlier frames tell of a pixel
    const DarkroomImage* transparency;  ///< the colour before anything transparent was drawn
    const DarkroomImage* exposure;      ///< one texel: what the host multiplies light by
    const DarkroomCamera* camera;       ///< null: the default one
    const DarkroomLight* lights;
    const DarkroomWatched* watched;
    uint32_t light_count;
    uint32_t watched_count;
    uint64_t frame_index;
    double time;        ///< seconds
    double delta_time;  ///< seconds; 0: 1/60; below 0 resets histories
} DarkroomFrame;

/// What every frame's image of one kind is. Both 0: not given, or the default that is said.
typedef struct DarkroomImageUse {
    uint32_t struct_size;
    VkFormat format;
    VkImageUsageFlags usage;  ///< 0: SAMPLED; of a target COLOR_ATTACHMENT
} DarkroomImageUse;

/// A picture of a plan that frames may look at: darkroom/watch.hpp.
typedef struct DarkroomWatch {
    uint32_t struct_size;
    uint32_t id;           ///< what frames and answers call it
    DarkroomHandle entry;  ///< its output; or DARKROOM_SCENE_COLOR
    const char* image;     ///< where no entry is given: an image of the plan
    uint32_t mip_level;
    const DarkroomImageUse* target;  ///< null: R32G32B32A32_SFLOAT, COLOR_ATTACHMENT
} DarkroomWatch;
/// What the last record made of a watch.
typedef enum DarkroomWatchState {
    DARKROOM_WATCH_NOT_IN_PLAN = 0,
    DARKROOM_WATCH_NOT_GIVEN = 1,
    DARKROOM_WATCH_NOT_WRITTEN = 2,
    DARKROOM_WATCH_INPUT_SHOWN = 3,  ///< the entry is off or left out
    DARKROOM_WATCH_SHOWN = 4
} DarkroomWatchState;

/// Which shader stage runs the kernels; both give the same picture.
typedef enum DarkroomKernelStage {
    DARKROOM_KERNEL_STAGE_AUTO = 0,
    DARKROOM_KERNEL_STAGE_COMPUTE = 1,
    DARKROOM_KERNEL_STAGE_RASTER = 2
} DarkroomKernelStage;
/// A choice that the library makes, or the host.
typedef enum DarkroomChoice {
    DARKROOM_CHOICE_AUTO = 0,
    DARKROOM_CHOICE_NO = 1,
    DARKROOM_CHOICE_YES = 2
} DarkroomChoice;

/// What the frames will be like. Compile again when one of these changes.
typedef struct DarkroomCompileDesc {
    uint32_t struct_size;
    uint32_t views;             ///< 0: 1
    VkExtent2D max_extent;
    VkExtent2D target_extent;   ///< (0, 0): that of the picture at the end of the stack
    const DarkroomImageUse* color;   ///< null: R16G16B16A16_SFLOAT
    const DarkroomImageUse* target;  ///< null: R8G8B8A8_UNORM
    const DarkroomImageUse* depth;
    const DarkroomImageUse* normals;
    const DarkroomImageUse* velocity;
    const DarkroomImageUse* ui;
    const DarkroomImageUse* reactive;
    const DarkroomImageUse* transparency;
    const DarkroomImageUse* exposure;
    const DarkroomColorState* target_color;  ///< what the target takes; null: what its format says
    DarkroomChoice target_is_encoded;  ///< AUTO: of UNORM and SRGB formats; NO: scene-linear, as float files
    DarkroomChoice encodes_target;     ///< whether light that the stack leaves is then sRGB-encoded; AUTO: for UNORM
    VkBool32 is_color_associated;      ///< the frames' colour is multiplied by its alpha
    VkBool32 is_depth_planar;          ///< every frame's camera says DARKROOM_DEPTH_PLANAR
    VkBool32 is_velocity_plain;        ///< every frame's camera says the default velocity
    VkBool32 has_shadows;              ///< frames have lights with cascades
    VkBool32 no_fusion;                ///< every effect a pass of its own (tests, benchmarks)
    DarkroomKernelStage kernels;
    VkFormat intermediate;             ///< of pictures between kernels; 0: R16G16B16A16_SFLOAT
    uint32_t watch_count;
    const DarkroomWatch* watches;
} DarkroomCompileDesc;

// ---------------------------------------------------------------------------------------------------------------------
// The composer: its stack

/// How one picture goes over another.
typedef enum DarkroomBlendMode {
    DARKROOM_BLEND_MIX = 0,
    DARKROOM_BLEND_ADD = 1,
    DARKROOM_BLEND_SCREEN = 2,
    DARKROOM_BLEND_MULTIPLY = 3,
    DARKROOM_BLEND_LIGHTEN = 4,
    DARKROOM_BLEND_DARKEN = 5,
    DARKROOM_BLEND_DIFFERENCE = 6,
    DARKROOM_BLEND_OVERLAY = 7,
    DARKROOM_BLEND_SOFT_LIGHT = 8
} DarkroomBlendMode;

/// What belongs to the entry, not to the effect.
typedef struct DarkroomEntryDesc {
    uint32_t struct_size;
    DarkroomBlendMode blend;  ///< how the result goes over the input
    DarkroomHandle input;     ///< the picture; 0: the entry before
    DarkroomHandle source;    ///< what effects with passes read instead of the picture
    DarkroomHandle second;    ///< the second picture of effects that take two
    DarkroomHandle mask;      ///< luminance of this picture scales opacity
    const char* name;         ///< null: the effect's name, then name#2 ...
    const char* output;       ///< a name for its output, for looks
    float opacity;            ///< [0, 1]; 0 without has_opacity: 1
    VkBool32 is_ui;           ///< of the interface's own chain
    VkBool32 is_disabled;
    uint32_t scale_numerator;    ///< size that the entry works at, relative to its input; 0: 1
    uint32_t scale_denominator;
    VkFormat format;             ///< of the image that holds its output; 0: that of pictures between kernels
    const uint32_t* words;       ///< all of the effect's parameters, word_count of DarkroomEffectInfo; null: defaults
    uint32_t word_count;
    VkBool32 has_opacity;        ///< an opacity of 0 is meant; darkroom_composer_desc sets it
} DarkroomEntryDesc;

/// What a composer is made with.
typedef struct DarkroomComposerDesc {
    uint32_t struct_size;
    uint32_t frames_in_flight;  ///< 0: 2
    VkBool32 has_timers;        ///< GPU timestamps around every pass
    VkBool32 no_threads;        ///< compile_later compiles before it returns
    uint32_t max_threads;       ///< beside the caller's; 0: as many as processors
} DarkroomComposerDesc;

/// `desc` may be null.
DARKROOM_API DarkroomResult darkroom_composer_create(DarkroomDevice device, const DarkroomComposerDesc* desc,
                                                     DarkroomComposer* composer);
/// Only when all its recordings have finished.
DARKROOM_API void darkroom_composer_destroy(DarkroomComposer composer);
/// Where within the pixel a frame is drawn, for effects that gather earlier frames: DarkroomCamera::jitter. `scale`:
/// lines of the output to those of the frame, 1 and more.
DARKROOM_API void darkroom_composer_jitter(uint64_t frame_index, float scale, float jitter[2]);
/// What to add to the mip bias of all samplers of the scene.
DARKROOM_API float darkroom_composer_mip_bias(float scale);
/// Moves a projection by `jitter`, in pixels of a picture of `extent`, y down. The two matrices may be one.
DARKROOM_API void darkroom_jittered(const float projection[16], const float jitter[2], VkExtent2D extent,
                                    VkBool32 is_y_up, float out[16]);

/// Appends an effect. `desc` and `handle` may be null.
DARKROOM_API DarkroomResult darkroom_composer_add(DarkroomComposer composer, const char* effect,
                                                  const DarkroomEntryDesc* desc, DarkroomHandle* handle);
/// The same for an effect that was found, or is of a file.
DARKROOM_API DarkroomResult darkroom_composer_add_effect(DarkroomComposer composer, DarkroomEffect effect,
                                                         const DarkroomEntryDesc* desc, DarkroomHandle* handle);
/// Puts an effect in front of an entry.
DARKROOM_API DarkroomResult darkroom_composer_insert(DarkroomComposer composer, DarkroomHandle before,
                                                     DarkroomEffect effect, const DarkroomEntryDesc* desc,
                                                     DarkroomHandle* handle);
/// Takes an entry out. Entries that name it must be removed or wired anew before the next compile.
DARKROOM_API DarkroomResult darkroom_composer_remove(DarkroomComposer composer, DarkroomHandle handle);
/// Puts an entry in front of another; `before` 0: behind the last.
DARKROOM_API DarkroomResult darkroom_composer_move(DarkroomComposer composer, DarkroomHandle handle,
                                                   DarkroomHandle before);
/// Another effect in an entry's place, at its defaults, with its handle, name and wiring.
DARKROOM_API DarkroomResult darkroom_composer_replace(DarkroomComposer composer, DarkroomHandle handle,
                                                      DarkroomEffect effect);
/// Wires an entry anew: all of `desc` but whether it is on, and its words. Needs a compile.
DARKROOM_API DarkroomResult darkroom_composer_rewire(DarkroomComposer composer, DarkroomHandle handle,
                                                     const DarkroomEntryDesc* desc);
/// Takes all entries out.
DARKROOM_API DarkroomResult darkroom_composer_clear(DarkroomComposer composer);

/// A table of colours: a 1D one (a shaper), a 3D one (a cube), or the first before the second.
typedef struct DarkroomTable {
    uint32_t struct_size;
    uint32_t shaper_size;  ///< entries; 0: none
    uint32_t size;         ///< edge of the cube; 0: none
    float shaper_min[3];   ///< inputs of its first and last entry; all six 0: 0 and 1
    float shaper_max[3];
    float min[3];          ///< the same of the cube
    float max[3];
    const float* shaper;   ///< shaper_size triples
    const float* cube;     ///< size^3 triples, red runs fastest
} DarkroomTable;
/// A picture: row-major, top row first, scene-linear, four numbers a pixel.
typedef struct DarkroomPicture {
    uint32_t struct_size;
    uint32_t width;
    uint32_t height;
    const float* rgba;
} DarkroomPicture;
/// For parameters of kind DARKROOM_KIND_RESOURCE, and by darkroom_composer_picture_of as an input. The data is copied.
DARKROOM_API DarkroomResult darkroom_composer_define_table(DarkroomComposer composer, const DarkroomTable* table,
                                                           uint32_t* resource);
/// The same for a picture.
DARKROOM_API DarkroomResult darkroom_composer_define_picture(DarkroomComposer composer, const DarkroomPicture* picture,
                                                             uint32_t* resource);
/// Frees it with the last plan that was compiled with it.
DARKROOM_API DarkroomResult darkroom_composer_forget(DarkroomComposer composer, uint32_t resource);
/// Those that are defined. `count` is the room in `resources`, and becomes what there are; `resources` may be null.
DARKROOM_API DarkroomResult darkroom_composer_resources(DarkroomComposer composer, uint32_t* resources,
                                                        uint32_t* count);
/// A picture that was defined, as an input for any entry.
DARKROOM_API DarkroomHandle darkroom_composer_picture_of(uint32_t resource);
/// The same picture one frame before: an input for any entry.
DARKROOM_API DarkroomHandle darkroom_handle_previous(DarkroomHandle handle);

/// By an entry's name.
DARKROOM_API DarkroomResult darkroom_composer_find(DarkroomComposer composer, const char* name, DarkroomHandle* handle);
/// How many entries the stack has.
DARKROOM_API DarkroomResult darkroom_composer_size(DarkroomComposer composer, uint32_t* count);
/// The entry at a place of the stack, from 0.
DARKROOM_API DarkroomResult darkroom_composer_entry(DarkroomComposer composer, uint32_t index, DarkroomHandle* handle);
/// Does the handle name an entry of this stack?
DARKROOM_API DarkroomResult darkroom_composer_check(DarkroomComposer composer, DarkroomHandle handle);
/// The entry's effect. Of a custom one the handle is valid until the last of its entries is removed or replaced.
DARKROOM_API DarkroomResult darkroom_composer_info(DarkroomComposer composer, DarkroomHandle handle,
                                                   DarkroomEffect* effect);
/// What the entry has beside its effect's parameters, and their base values. Texts and words are valid until the stack
/// is edited.
DARKROOM_API DarkroomResult darkroom_composer_desc(DarkroomComposer composer, DarkroomHandle handle,
                                                   DarkroomEntryDesc* desc);
/// Base values. `count` is the room in `words`, and becomes what there are; `words` may be null.
DARKROOM_API DarkroomResult darkroom_composer_words(DarkroomComposer composer, DarkroomHandle handle, uint32_t* words,
                                                    uint32_t* count);

// ---------------------------------------------------------------------------------------------------------------------
// The composer: values. The next record sees them; nothing is compiled on the calling thread.

/// Switches an entry on or off.
DARKROOM_API DarkroomResult darkroom_composer_set_enabled(DarkroomComposer composer, DarkroomHandle handle,
                                                          VkBool32 is_enabled);
/// [0, 1]. Of an entry that was compiled with 1 and has passes of its own, 0 and 1 alone.
DARKROOM_API DarkroomResult darkroom_composer_set_opacity(DarkroomComposer composer, DarkroomHandle handle,
                                                          float opacity);
/// A parameter of one number, a toggle (0 or 1), or a choice (its place). Out of range is refused with the interval.
DARKROOM_API DarkroomResult darkroom_composer_set_number(DarkroomComposer composer, DarkroomHandle handle,
                                                         const char* parameter, double value);
/// As a look writes it: "0.5", "on", "aces", "0.2 0.4 1".
DARKROOM_API DarkroomResult darkroom_composer_set_text(DarkroomComposer composer, DarkroomHandle handle,
                                                       const char* parameter, const char* value);
/// Words of the parameter's kind: floats, integers, 0 or 1, the place of a choice.
DARKROOM_API DarkroomResult darkroom_composer_set_words(DarkroomComposer composer, DarkroomHandle handle,
                                                        const char* parameter, const uint32_t* words, uint32_t count);
/// All parameters of the entry's effect.
DARKROOM_API DarkroomResult darkroom_composer_set_all(DarkroomComposer composer, DarkroomHandle handle,
                                                      const uint32_t* words, uint32_t count);

/// Finds a parameter once, for the functions below, which compare no names. It is good until its entry is removed or
/// gets another effect, and then an error.
DARKROOM_API DarkroomResult darkroom_composer_parameter(DarkroomComposer composer, DarkroomHandle handle,
                                                        const char* name, DarkroomParameter* parameter);
/// A number.
DARKROOM_API DarkroomResult darkroom_composer_set_float(DarkroomComposer composer, DarkroomParameter parameter,
                                                        float value);
/// An integer, a toggle or a choice.
DARKROOM_API DarkroomResult darkroom_composer_set_int(DarkroomComposer composer, DarkroomParameter parameter,
                                                      int32_t value);
/// Two to four numbers.
DARKROOM_API DarkroomResult darkroom_composer_set_vector(DarkroomComposer composer, DarkroomParameter parameter,
                                                         const float* values, uint32_t count);

/// A per-frame override by `owner` (a script, a timeline): replaces the value until dropped; the last to set wins.
DARKROOM_API DarkroomResult darkroom_composer_set_override(DarkroomComposer composer, DarkroomHandle handle,
                                                           const char* parameter, const char* owner,
                                                           const uint32_t* words, uint32_t count);
/// Takes back what this owner has set.
DARKROOM_API DarkroomResult darkroom_composer_drop_overrides(DarkroomComposer composer, const char* owner);
/// The values at the time and from the camera of the last record; `count` as in darkroom_composer_words.
DARKROOM_API DarkroomResult darkroom_composer_current(DarkroomComposer composer, DarkroomHandle handle, uint32_t* words,
                                                      uint32_t* count);
/// The same at any time and from any camera, and what layers make of the entry's state. All but `count` may be null.
DARKROOM_API DarkroomResult darkroom_composer_values_at(DarkroomComposer composer, DarkroomHandle handle, double time,
                                                        const DarkroomCamera* camera, uint32_t* words, uint32_t* count,
                                                        VkBool32* is_enabled, float* opacity);
/// How many frames to develop before the first that is wanted, so that a run which begins in the middle gives the
/// picture of an unbroken one. `delta_time`: seconds between frames; 0: 1/60; below 0: none.
DARKROOM_API DarkroomResult darkroom_composer_pre_roll(DarkroomComposer composer, double delta_time, uint32_t* frames);

/// How a pulse dies down: darkroom/modulation.hpp.
typedef enum DarkroomEnvelope {
    DARKROOM_ENVELOPE_LINEAR = 0,
    DARKROOM_ENVELOPE_EXPONENTIAL = 1,
    DARKROOM_ENVELOPE_SPRING = 2
} DarkroomEnvelope;
/// Of the amount of a pulse, `age` seconds after its event.
DARKROOM_API double darkroom_envelope(DarkroomEnvelope shape, double age, double duration);

/// What is added to a value when an event fires it, and dies down.
typedef struct DarkroomPulseDesc {
    uint32_t struct_size;
    DarkroomEnvelope envelope;
    const char* event;  ///< what fires it
    DarkroomHandle entry;
    const char* parameter;  ///< made of numbers
    float amount[4];        ///< added to each of its numbers, where the envelope is 1
    double duration;        ///< seconds; 0: 0.3
} DarkroomPulseDesc;
/// One value of a layer.
typedef struct DarkroomLayerValue {
    uint32_t struct_size;
    uint32_t word_count;
    DarkroomHandle entry;
    const char* parameter;  ///< of its effect; or the entry's own `enabled` or `opacity`
    const uint32_t* words;  ///< of the parameter's kind
} DarkroomLayerValue;
/// A set of other values, blended over the base by a weight.
typedef struct DarkroomLayerDesc {
    uint32_t struct_size;
    uint32_t value_count;
    const char* name;
    const DarkroomLayerValue* values;
    float weight;           ///< [0, 1]
    VkBool32 has_distance;  ///< the weight is multiplied: 1 at near_distance metres from a point, 0 from far_distance on
    float near_distance;
    float far_distance;
    float point[3];  ///< of the world
} DarkroomLayerDesc;
/// Errors: an entry or parameter that is not there, or is not made of numbers; a duration that is not above 0.
DARKROOM_API DarkroomResult darkroom_composer_add_pulse(DarkroomComposer composer, const DarkroomPulseDesc* desc);
/// Starts all pulses of this event anew at `time`, seconds; null: with the next record. `count`, which may be null: how
/// many there are.
DARKROOM_API DarkroomResult darkroom_composer_fire(DarkroomComposer composer, const char* event, const double* time,
                                                   uint32_t* count);
/// Layers are blended in the order they were added. Errors: a name that another layer has, no values, one out of range.
DARKROOM_API DarkroomResult darkroom_composer_add_layer(DarkroomComposer composer, const DarkroomLayerDesc* desc);
/// From 0, where the layer changes nothing, to 1, where its values replace the base's.
DARKROOM_API DarkroomResult darkroom_composer_set_layer_weight(DarkroomComposer composer, const char* name,
                                                               float weight);
/// Null: there are fewer layers, or no composer.
DARKROOM_API const char* darkroom_composer_layer_name(DarkroomComposer composer, uint32_t index);
/// Removes all of them.
DARKROOM_API DarkroomResult darkroom_composer_remove_pulses(DarkroomComposer composer);
/// A name that no layer has changes nothing.
DARKROOM_API DarkroomResult darkroom_composer_remove_layer(DarkroomComposer composer, const char* name);

// ---------------------------------------------------------------------------------------------------------------------
// The composer: plans and frames

/// Plans the stack, makes the kernels that the device does not have yet, allocates what it needs. `plan` may be null.
DARKROOM_API DarkroomResult darkroom_composer_compile(DarkroomComposer composer, const DarkroomCompileDesc* desc,
                                                      DarkroomPlan* plan);
/// The same on the composer's own thread. Returns at once; the first record behind it whose frame has the formats and
/// extents of `desc` takes the new plan, and until then frames of the old ones go on.
DARKROOM_API DarkroomResult darkroom_composer_compile_later(DarkroomComposer composer, const DarkroomCompileDesc* desc);
/// Is one under way, or ready for the next record? The result is that of the last one that has ended.
DARKROOM_API DarkroomResult darkroom_composer_pending(DarkroomComposer composer, VkBool32* is_pending);
/// The plan that the next record takes; null: none is ready. For a host that places barriers by what plans tell: from
/// the first call on, record takes no plan that the last call has not told of.
DARKROOM_API DarkroomResult darkroom_composer_coming_plan(DarkroomComposer composer, DarkroomPlan* plan);
/// What record works by. An error: nothing yet.
DARKROOM_API DarkroomResult darkroom_composer_current_plan(DarkroomComposer composer, DarkroomPlan* plan);
/// The same as compile without a device's objects, so on darkroom_device_assumed, too.
DARKROOM_API DarkroomResult darkroom_composer_plan(DarkroomComposer composer, const DarkroomCompileDesc* desc,
                                                   DarkroomPlan* plan);
/// One number that the driver's compiler tells of a kernel, under the driver's own name.
typedef struct DarkroomKernelValue {
    uint32_t struct_size;
    uint32_t subgroup;      ///< threads that run in step
    uint32_t workgroup[2];  ///< 1, 1 of a fragment shader
    const char* kernel;     ///< of the pass
    const char* name;
    double value;
} DarkroomKernelValue;
/// Those of all kernels of that plan, kernel by kernel. Needs a device of DarkroomDeviceDesc::compiles_only. `count` is
/// the room in `values`, and becomes what there are; `values` may be null.
DARKROOM_API DarkroomResult darkroom_composer_statistics(DarkroomComposer composer, const DarkroomCompileDesc* desc,
                                                         DarkroomKernelValue* values, uint32_t* count);
/// For people.
DARKROOM_API const char* darkroom_plan_text(DarkroomPlan plan);
/// For programs: passes, images, what was left out and why, remarks.
DARKROOM_API const char* darkroom_plan_json(DarkroomPlan plan);
/// Of all passes, each input texel counted once.
DARKROOM_API uint64_t darkroom_plan_bytes_read(DarkroomPlan plan);
/// Of all passes.
DARKROOM_API uint64_t darkroom_plan_bytes_written(DarkroomPlan plan);
/// Composers do not need it.
DARKROOM_API void darkroom_plan_destroy(DarkroomPlan plan);

/// Records the whole stack. Waits for nothing, submits nothing, and allocates nothing but, once, room for more lights or
/// watches than any frame before had. Errors record nothing.
DARKROOM_API DarkroomResult darkroom_composer_record(DarkroomComposer composer, VkCommandBuffer commands,
                                                     const DarkroomFrame* frame);
/// The last recording will not be submitted: what it did to histories and the ring of frames is taken back.
DARKROOM_API DarkroomResult darkroom_composer_abandon(DarkroomComposer composer);
/// Of a watch, by DarkroomWatch::id.
DARKROOM_API DarkroomResult darkroom_composer_watch_state(DarkroomComposer composer, uint32_t id,
                                                          DarkroomWatchState* state);
/// Waits for kernels that are being built for the present toggles. For headless work, not for frame loops.
DARKROOM_API DarkroomResult darkroom_composer_wait_for_kernels(DarkroomComposer composer);
/// GPU time of one pass.
typedef struct DarkroomPassTime {
    uint32_t struct_size;
    const char* name;
    double milliseconds;
} DarkroomPassTime;
/// Of the last recording that has finished; none without timers. `count` is the room in `passes`, and becomes what there
/// are; `passes` and `frame_index` may be null.
DARKROOM_API DarkroomResult darkroom_composer_times(DarkroomComposer composer, uint64_t* frame_index,
                                                    DarkroomPassTime* passes, uint32_t* count);
/// A value that effects of the plan make ("auto_exposure.exposure"), as the newest finished recording of the view left
/// it. `count` is the room in `numbers`, and becomes what there are: 0 while none has finished. `frame_index` may be
/// null.
DARKROOM_API DarkroomResult darkroom_composer_value(DarkroomComposer composer, const char* name, uint32_t view,
                                                    uint64_t* frame_index, float* numbers, uint32_t* count);
/// CPU time of the last record.
DARKROOM_API DarkroomResult darkroom_composer_record_microseconds(DarkroomComposer composer, double* microseconds);
/// After device loss: keeps the stack, compiles it on another device. `plan` may be null.
DARKROOM_API DarkroomResult darkroom_composer_rebind(DarkroomComposer composer, DarkroomDevice device,
                                                     DarkroomPlan* plan);

// ---------------------------------------------------------------------------------------------------------------------
// Kernels made ahead of time: darkroom/kernel_file.hpp

/// An empty file.
DARKROOM_API DarkroomResult darkroom_kernel_file_create(DarkroomKernelFile* file);
/// What bytes it gave goes with it.
DARKROOM_API void darkroom_kernel_file_destroy(DarkroomKernelFile file);
/// What this stack asks for in frames of `desc`. The composer is on a device of darkroom_device_assumed.
DARKROOM_API DarkroomResult darkroom_kernel_file_add(DarkroomKernelFile file, DarkroomComposer composer,
                                                     const DarkroomCompileDesc* desc);
/// How many shaders there are.
DARKROOM_API DarkroomResult darkroom_kernel_file_size(DarkroomKernelFile file, uint32_t* count);
/// The file for DarkroomDeviceDesc::kernels. Valid until the next call with it.
DARKROOM_API DarkroomResult darkroom_kernel_file_bytes(DarkroomKernelFile file, const void** bytes, size_t* size);

// ---------------------------------------------------------------------------------------------------------------------
// Looks: darkroom/look.hpp. DARKROOM_ERROR_UNSUPPORTED where the library was built without them.

/// The two shipped orders of the flat table.
typedef enum DarkroomLookOrder {
    DARKROOM_LOOK_ORDER_DOCUMENTED = 0,
    DARKROOM_LOOK_ORDER_SCENE_LINEAR = 1
} DarkroomLookOrder;
/// What a look names a file for.
typedef enum DarkroomFileUse {
    DARKROOM_FILE_USE_TABLE = 0,    ///< a table of colours
    DARKROOM_FILE_USE_NUMBERS = 1,  ///< a picture whose numbers count as they are in the file
    DARKROOM_FILE_USE_PICTURE = 2   ///< a picture to be seen, scene-linear
} DarkroomFileUse;
/// Reads a file that a look names: fills in `table` or `picture`, whose data is copied after it has returned. Another
/// result than DARKROOM_OK: it cannot be read.
typedef DarkroomResult (*DarkroomLoadResource)(void* user, const char* path, DarkroomFileUse use, DarkroomTable* table,
                                               DarkroomPicture* picture);
/// Takes a warning: "file:line:column: ..." of what was passed over.
typedef void (*DarkroomWarn)(void* user, const char* text);

/// How a look is read.
typedef struct DarkroomLookOptions {
    uint32_t struct_size;
    VkBool32 is_strict;              ///< unknown keys and values out of range are errors, not warnings
    VkBool32 allows_custom_effects;  ///< entries may name files, which are code
    VkBool32 no_modulation;          ///< pulses and layers are passed over
    VkBool32 no_tables;              ///< no .cube file is read: load_resource brings all
    const char* folder;              ///< that files are relative to; null: the look's own
    DarkroomLoadResource load_resource;  ///< null: colour tables in .cube files alone
    DarkroomWarn warn;
    void* user;  ///< of both
} DarkroomLookOptions;

/// The flat table with nothing written in it but its order.
DARKROOM_API DarkroomResult darkroom_look_default(DarkroomLookOrder order, DarkroomLook* look);
/// The same for pictures that a path tracer or a camera made.
DARKROOM_API DarkroomResult darkroom_look_default_of_traced_light(DarkroomLook* look);
/// Errors are "shown_name:line:column: thing, value, what is allowed, nearest name". `options` may be null.
DARKROOM_API DarkroomResult darkroom_look_parse(const char* text, const char* shown_name,
                                                const DarkroomLookOptions* options, DarkroomLook* look);
/// The same of a file.
DARKROOM_API DarkroomResult darkroom_look_read(const char* path, const DarkroomLookOptions* options,
                                               DarkroomLook* look);
/// Composers that it was applied to do not need it.
DARKROOM_API void darkroom_look_destroy(DarkroomLook look);
/// As a file that reads back as the same look. Null: there is no look.
DARKROOM_API const char* darkroom_look_write(DarkroomLook look);
/// Of a flat look, values that are the defaults of its order become those of the new one.
DARKROOM_API DarkroomResult darkroom_look_set_order(DarkroomLook look, DarkroomLookOrder order);
/// Makes it what remains where post-processing is off: its exposure, tone mapping, encoding, and the interface.
DARKROOM_API DarkroomResult darkroom_look_switch_off(DarkroomLook look);
/// The multiplier of the scene's light that the look has.
DARKROOM_API DarkroomResult darkroom_look_exposure(DarkroomLook look, float* exposure);
/// Gives it the interface's own chain, at its defaults where it has none.
DARKROOM_API DarkroomResult darkroom_look_add_ui(DarkroomLook look);
/// Lays what a file writes in [post_process] over the look.
DARKROOM_API DarkroomResult darkroom_look_lay_over(DarkroomLook look, const char* file,
                                                   const DarkroomLookOptions* options);
/// A value as the command line has it: "bloom_intensity", "bloom_enabled", "bloom#2.intensity".
DARKROOM_API DarkroomResult darkroom_look_override(DarkroomLook look, const char* key, const char* value);
/// Puts an effect behind the last place where the picture is in a domain that it accepts.
DARKROOM_API DarkroomResult darkroom_look_place(DarkroomLook look, const char* effect);
/// The same for the effect in a file of GLSL.
DARKROOM_API DarkroomResult darkroom_look_place_custom(DarkroomLook look, const char* file);
/// The name of each entry, in order. Null: there are fewer.
DARKROOM_API const char* darkroom_look_entry_name(DarkroomLook look, uint32_t index);

/// What gets a place in the stack.
typedef struct DarkroomApplyOptions {
    uint32_t struct_size;
    VkBool32 keeps_what_is_off;  ///< gives effects of the flat table that are off their place
    const char* const* keeps;    ///< the same for entries of these names
    uint32_t keep_count;
} DarkroomApplyOptions;
/// Appends the look's entries, pulses and layers to the composer. `options` may be null.
DARKROOM_API DarkroomResult darkroom_look_apply(DarkroomLook look, DarkroomComposer composer,
                                                const DarkroomApplyOptions* options);
/// Takes a composer that holds one look to another. `needs_compile`, which may be null: values alone do not.
DARKROOM_API DarkroomResult darkroom_look_follow(DarkroomLook was, DarkroomLook is, DarkroomComposer composer,
                                                 const DarkroomApplyOptions* options, VkBool32* needs_compile);

// ---------------------------------------------------------------------------------------------------------------------
// The interface

/// The interface lags behind the head that wears it: darkroom/hud_inertia.hpp.
DARKROOM_API DarkroomResult darkroom_hud_inertia_create(DarkroomHudInertia* inertia);
DARKROOM_API void darkroom_hud_inertia_destroy(DarkroomHudInertia inertia);
/// `yaw`: degrees; `velocity_z`: of the player, upward. `offset`: in uv.
DARKROOM_API DarkroomResult darkroom_hud_inertia_step(DarkroomHudInertia inertia, double delta_time, double yaw,
                                                      VkBool32 is_on_ground, double velocity_z, float offset[2]);
/// Of the last step.
DARKROOM_API DarkroomResult darkroom_hud_inertia_offset(DarkroomHudInertia inertia, float offset[2]);
/// At rest, and without a frame before.
DARKROOM_API DarkroomResult darkroom_hud_inertia_reset(DarkroomHudInertia inertia);

/// Ten floats in the order of DarkroomUiConstants (darkroom/ui_constants.hpp), for a picture of `height` lines.
DARKROOM_API DarkroomResult darkroom_composer_set_ui_constants(DarkroomComposer composer, const float constants[10],
                                                               uint32_t height);
/// What is wrong with a frame's camera, depth and velocity, as one text, a sentence a line; empty: nothing. `depth` and
/// `velocity` (x, y) have width * height and twice as many numbers. Valid until the next call of this thread.
DARKROOM_API DarkroomResult darkroom_check_temporal(const DarkroomCamera* camera, VkExtent2D extent, const float* depth,
                                                    const float* velocity, const char** text);

#ifdef __cplusplus
}
#endif

#endif
