// SPDX-License-Identifier: MIT
// What host.py does, in Rust. `darkroom` and `layout` are generated beside a copy of this file.
mod darkroom;
mod layout;
use darkroom::*;
use std::ffi::CString;
use std::os::raw::{c_char, c_void};
use std::ptr::{null, null_mut};

fn c(text: &str) -> CString {
    CString::new(text).unwrap()
}

unsafe extern "C" fn warn(user: *mut c_void, said: *const c_char) {
    unsafe { (*(user as *mut Vec<String>)).push(text(said).unwrap()) };
}

fn run() -> Result<(), String> {
    unsafe {
        for i in 0..darkroom_effect_count() {
            let mut info = DarkroomEffectInfo::default();
            checked::effect_info(darkroom_effect_at(i), &mut info)?;
            println!("effect {}", text(info.name).unwrap());
        }

        let mut device: DarkroomDevice = null_mut();
        checked::device_assumed(DARKROOM_DEVICE_PROFILE_GPU, &mut device)?;
        let mut composer: DarkroomComposer = null_mut();
        checked::composer_create(device, null(), &mut composer)?;
        let mut bloom: DarkroomHandle = 0;
        let entry = DarkroomEntryDesc { opacity: 0.5, ..Default::default() };
        checked::composer_add(composer, c("bloom").as_ptr(), &entry, &mut bloom)?;
        checked::composer_set_number(composer, bloom, c("intensity").as_ptr(), 0.25)?;
        checked::composer_add(composer, c("exposure").as_ptr(), null(), null_mut())?;
        checked::composer_add(composer, c("tonemap").as_ptr(), null(), null_mut())?;
        let mut tonemap: DarkroomHandle = 0;
        checked::composer_find(composer, c("tonemap").as_ptr(), &mut tonemap)?;
        checked::composer_set_text(composer, tonemap, c("curve").as_ptr(), c("agx").as_ptr())?;
        checked::composer_add(composer, c("encode").as_ptr(), null(), null_mut())?;
        let mut parameter: DarkroomParameter = 0;
        checked::composer_parameter(composer, bloom, c("intensity").as_ptr(), &mut parameter)?;
        checked::composer_set_float(composer, parameter, 0.5)?;
        let (mut count, mut word) = (1u32, 0u32);
        checked::composer_words(composer, bloom, &mut word, &mut count)?;
        println!("words {}", count);

        let desc = DarkroomCompileDesc { max_extent: VkExtent2D { width: 640, height: 360 }, ..Default::default() };
        let mut plan: DarkroomPlan = null_mut();
        checked::composer_plan(composer, &desc, &mut plan)?;
        println!("{}", text(darkroom_plan_text(plan)).unwrap());
        darkroom_plan_destroy(plan);

        let mut look: DarkroomLook = null_mut();
        let short = c("format = 1\n[[stack]]\neffect = \"vignette\"\n");
        checked::look_parse(short.as_ptr(), c("short.toml").as_ptr(), null(), &mut look)?;
        let name = |index| text(darkroom_look_entry_name(look, index)).unwrap_or("None".to_string());
        println!("look {} {}", name(0), name(1));
        darkroom_look_destroy(look);
        let mut warned: Vec<String> = Vec::new();
        let options =
            DarkroomLookOptions { warn: Some(warn), user: &mut warned as *mut _ as *mut c_void, ..Default::default() };
        let unknown = c("format = 1\n[post_process]\nbloom_intensitty = 1\n");
        checked::look_parse(unknown.as_ptr(), c("warned.toml").as_ptr(), &options, &mut look)?;
        println!("warning {}", warned.join(" "));
        darkroom_look_destroy(look);

        let wrong = c("[post_process]\nexposure = \"é\"\n");
        for result in [
            checked::composer_set_number(composer, bloom, c("intensity").as_ptr(), -1.0),
            checked::look_parse(wrong.as_ptr(), c("wrong.toml").as_ptr(), null(), &mut look),
            checked::device_assumed(7, &mut device),
        ] {
            println!("error {} {}", DARKROOM_ERROR_USER, result.unwrap_err());
        }
        darkroom_composer_destroy(composer);
        darkroom_device_destroy(device);
        Ok(())
    }
}

fn main() {
    assert_eq!(unsafe { darkroom_version() }, DARKROOM_VERSION);
    if std::env::args().nth(1).as_deref() == Some("layout") {
        layout::print();
    } else {
        run().unwrap();
    }
}
