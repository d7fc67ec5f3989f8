// SPDX-License-Identifier: MIT
// The functions for looks in a library without them.
#include "c/call.hpp"

using namespace darkroom;
using namespace darkroom::c;

namespace {

DarkroomResult unsupported(const char* function) {
    return tell(function,
                {Fault::User, "this library was built without looks (DARKROOM_LOOKS=OFF)", ErrorCode::Unsupported});
}

}  // namespace

DarkroomResult darkroom_look_default(DarkroomLookOrder, DarkroomLook*) { return unsupported("darkroom_look_default"); }
DarkroomResult darkroom_look_default_of_traced_light(DarkroomLook*) {
    return unsupported("darkroom_look_default_of_traced_light");
}
DarkroomResult darkroom_look_parse(const char*, const char*, const DarkroomLookOptions*, DarkroomLook*) {
    return unsupported("darkroom_look_parse");
}
DarkroomResult darkroom_look_read(const char*, const DarkroomLookOptions*, DarkroomLook*) {
    return unsupported("darkroom_look_read");
}
void darkroom_look_destroy(DarkroomLook) {}
const char* darkroom_look_write(DarkroomLook) { return nullptr; }
DarkroomResult darkroom_look_set_order(DarkroomLook, DarkroomLookOrder) {
    return unsupported("darkroom_look_set_order");
}
DarkroomResult darkroom_look_switch_off(DarkroomLook) { return unsupported("darkroom_look_switch_off"); }
DarkroomResult darkroom_look_exposure(DarkroomLook, float*) { return unsupported("darkroom_look_exposure"); }
DarkroomResult darkroom_look_add_ui(DarkroomLook) { return unsupported("darkroom_look_add_ui"); }
DarkroomResult darkroom_look_lay_over(DarkroomLook, const char*, const DarkroomLookOptions*) {
    return unsupported("darkroom_look_lay_over");
}
DarkroomResult darkroom_look_override(DarkroomLook, const char*, const char*) {
    return unsupported("darkroom_look_override");
}
DarkroomResult darkroom_look_place(DarkroomLook, const char*) { return unsupported("darkroom_look_place"); }
DarkroomResult darkroom_look_place_custom(DarkroomLook, const char*) {
    return unsupported("darkroom_look_place_custom");
}
const char* darkroom_look_entry_name(DarkroomLook, uint32_t) { return nullptr; }
DarkroomResult darkroom_look_apply(DarkroomLook, DarkroomComposer, const DarkroomApplyOptions*) {
    return unsupported("darkroom_look_apply");
}
DarkroomResult darkroom_look_follow(DarkroomLook, DarkroomLook, DarkroomComposer, const DarkroomApplyOptions*,
                                    VkBool32*) {
    return unsupported("darkroom_look_follow");
}
