// Which of the shared characters are people.
#pragma once

namespace limber::testing {

// Below the shared folder's "rigged": people and other upright bipeds, each with its artist's rig.
inline constexpr const char* kSharedPeople[] = {"cesium_man.glb",
                                                "kaykit_mannequin/manny_med_mod.gltf",
                                                "kenney_human.glb",
                                                "m2m_human_female.glb",
                                                "m2m_human_male.glb",
                                                "m2m_human_zombie.glb",
                                                "makehuman_cmu_mb.glb",
                                                "makehuman_default.glb",
                                                "makehuman_game_engine.glb",
                                                "makehuman_mixamo.glb",
                                                "quaternius_cyberpunk_character.glb",
                                                "quaternius_knightcharacter.glb",
                                                "quaternius_man_casual.glb",
                                                "quaternius_man_king.glb",
                                                "quaternius_man_spacesuit.glb",
                                                "quaternius_mech_george.glb",
                                                "quaternius_platformer_character.glb",
                                                "quaternius_platformer_character_humanoidrig.glb",
                                                "quaternius_woman_casual.glb",
                                                "quaternius_woman_scifi.glb",
                                                "robot_expressive.glb"};

}  // namespace limber::testing
