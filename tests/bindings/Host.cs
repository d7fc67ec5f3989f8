// SPDX-License-Identifier: MIT
// What host.py does, in C#.
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using Darkroom;

static unsafe class Host {
    static void Run() {
        for (uint i = 0; i < Api.EffectCount(); ++i) {
            DarkroomEffectInfo info = DarkroomEffectInfo.Create();
            Api.EffectInfo(Api.EffectAt(i), &info);
            Console.WriteLine("effect " + Api.Text(info.name));
        }

        IntPtr device, composer;
        Api.DeviceAssumed(DarkroomDeviceProfile.DARKROOM_DEVICE_PROFILE_GPU, &device);
        Api.ComposerCreate(device, null, &composer);
        ulong bloom, tonemap, parameter;
        DarkroomEntryDesc entry = DarkroomEntryDesc.Create();
        entry.opacity = 0.5f;
        Api.ComposerAdd(composer, "bloom", &entry, &bloom);
        Api.ComposerSetNumber(composer, bloom, "intensity", 0.25);
        Api.ComposerAdd(composer, "exposure", null, null);
        Api.ComposerAdd(composer, "tonemap", null, null);
        Api.ComposerFind(composer, "tonemap", &tonemap);
        Api.ComposerSetText(composer, tonemap, "curve", "agx");
        Api.ComposerAdd(composer, "encode", null, null);
        Api.ComposerParameter(composer, bloom, "intensity", &parameter);
        Api.ComposerSetFloat(composer, parameter, 0.5f);
        uint count = 1, word;
        Api.ComposerWords(composer, bloom, &word, &count);
        Console.WriteLine("words " + count);

        IntPtr plan;
        DarkroomCompileDesc desc = DarkroomCompileDesc.Create();
        desc.max_extent = new VkExtent2D { width = 640, height = 360 };
        Api.ComposerPlan(composer, &desc, &plan);
        Console.WriteLine(Api.PlanText(plan));
        Api.PlanDestroy(plan);

        IntPtr look;
        Api.LookParse("format = 1\n[[stack]]\neffect = \"vignette\"\n", "short.toml", null, &look);
        Console.WriteLine("look " + Api.LookEntryName(look, 0) + " " + (Api.LookEntryName(look, 1) ?? "None"));
        Api.LookDestroy(look);
        List<string> warned = new List<string>();
        DarkroomWarn warn = delegate(void* user, byte* text) { warned.Add(Api.Text(text)); };
        DarkroomLookOptions options = DarkroomLookOptions.Create();
        options.warn = Marshal.GetFunctionPointerForDelegate(warn);
        Api.LookParse("format = 1\n[post_process]\nbloom_intensitty = 1\n", "warned.toml", &options, &look);
        GC.KeepAlive(warn);
        Console.WriteLine("warning " + string.Join(" ", warned));
        Api.LookDestroy(look);

        // An anonymous function takes no variable that has an address.
        IntPtr stack = composer;
        ulong handle = bloom;
        Action[] wrong = {
            delegate { Api.ComposerSetNumber(stack, handle, "intensity", -1); },
            delegate { IntPtr none; Api.LookParse("[post_process]\nexposure = \"é\"\n", "wrong.toml", null, &none); },
            delegate { IntPtr none; Api.DeviceAssumed((DarkroomDeviceProfile)7, &none); },
        };
        foreach (Action call in wrong) {
            try {
                call();
                Console.WriteLine("no error");
            } catch (DarkroomException error) {
                Console.WriteLine("error " + (int)error.Result + " " + error.Message);
            }
        }
        Api.ComposerDestroy(composer);
        Api.DeviceDestroy(device);
    }

    static void Main(string[] arguments) {
        Console.OutputEncoding = new System.Text.UTF8Encoding(false);
        if (arguments.Length > 0 && arguments[0] == "layout")
            Layout.Print();
        else
            Run();
    }
}
