# SPDX-License-Identifier: MIT
"""host.py BINDINGS LIBRARY [layout]: what the hosts of all languages do and print, over the C interface."""

import ctypes
import sys

sys.path.insert(0, sys.argv[1])
import darkroom_ctypes as dr  # noqa: E402


def print_layout():
    structs = [value for value in vars(dr).values() if isinstance(value, type) and issubclass(value, ctypes.Structure)]
    for struct in structs:
        for name, *_ in getattr(struct, "_fields_", []):
            if name == struct._fields_[0][0]:
                print(struct.__name__, ctypes.sizeof(struct))
            member = getattr(struct, name)
            print(f"{struct.__name__}.{name}", member.offset, member.size)


def main():
    lib = dr.Library(sys.argv[2])
    for i in range(lib.effect_count()):
        info = dr.DarkroomEffectInfo()
        lib.effect_info(lib.effect_at(i), info)
        print("effect", info.name.decode())

    device = dr.DarkroomDevice()
    lib.device_assumed(dr.DarkroomDeviceProfile.DARKROOM_DEVICE_PROFILE_GPU, device)
    composer = dr.DarkroomComposer()
    lib.composer_create(device, None, composer)
    bloom = ctypes.c_uint64()
    lib.composer_add(composer, "bloom", dr.DarkroomEntryDesc(opacity=0.5), bloom)
    lib.composer_set_number(composer, bloom, "intensity", 0.25)
    lib.composer_add(composer, "exposure", None, None)
    lib.composer_add(composer, "tonemap", None, None)
    tonemap = ctypes.c_uint64()
    lib.composer_find(composer, "tonemap", tonemap)
    lib.composer_set_text(composer, tonemap, "curve", "agx")
    lib.composer_add(composer, "encode", None, None)
    parameter = ctypes.c_uint64()
    lib.composer_parameter(composer, bloom, "intensity", parameter)
    lib.composer_set_float(composer, parameter, 0.5)
    count = ctypes.c_uint32(1)
    word = ctypes.c_uint32()
    lib.composer_words(composer, bloom, word, count)
    print("words", count.value)

    plan = dr.DarkroomPlan()
    lib.composer_plan(composer, dr.DarkroomCompileDesc(max_extent=dr.VkExtent2D(640, 360)), plan)
    print(lib.plan_text(plan))
    lib.plan_destroy(plan)

    look = dr.DarkroomLook()
    lib.look_parse("format = 1\n[[stack]]\neffect = \"vignette\"\n", "short.toml", None, look)
    print("look", lib.look_entry_name(look, 0), lib.look_entry_name(look, 1))
    lib.look_destroy(look)
    warned = []
    warn = dr.DarkroomWarn(lambda user, text: warned.append(text.decode()))
    lib.look_parse("format = 1\n[post_process]\nbloom_intensitty = 1\n", "warned.toml",
                   dr.DarkroomLookOptions(warn=warn), look)
    print("warning", *warned)
    lib.look_destroy(look)

    for call in (lambda: lib.composer_set_number(composer, bloom, "intensity", -1),
                 lambda: lib.look_parse("[post_process]\nexposure = \"é\"\n", "wrong.toml", None, look),
                 lambda: lib.device_assumed(7, device)):
        try:
            call()
            print("no error")
        except dr.DarkroomError as error:
            print("error", int(error.result), error)
    lib.composer_destroy(composer)
    lib.device_destroy(device)


print_layout() if "layout" in sys.argv else main()
