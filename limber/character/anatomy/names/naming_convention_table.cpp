// The conventions themselves. Each list is as its program documents it or writes it; programs with the same names
// (MotionBuilder's characters are those of many capture systems) have one row.
#include "limber/character/anatomy/names/naming_convention.h"

#include <algorithm>

namespace limber {

namespace {

using enum JointRole;

// The rows of several lists as one.
template <std::size_t... kSizes>
constexpr auto joined(const RoleNames (&... lists)[kSizes]) {
  std::array<RoleNames, (kSizes + ...)> all{};
  auto end = all.begin();
  ((end = std::copy(std::begin(lists), std::end(lists), end)), ...);
  return all;
}

// clang-format off
constexpr RoleNames kMixamo[] = {
    {kHips, "Hips"}, {kTrunk, "Spine[#]"}, {kNeck, "Neck[#]"}, {kHead, "Head"}, {kEye, "@Eye"},
    {kTip, "HeadTop_End @Toe_End @Eye_end"},
    {kCollar, "@Shoulder"}, {kUpperArm, "@Arm"}, {kLowerArm, "@ForeArm"}, {kHand, "@Hand"},
    {kThumb, "@HandThumb#"}, {kIndex, "@HandIndex#"}, {kMiddle, "@HandMiddle#"}, {kRing, "@HandRing#"}, {kLittle, "@HandPinky#"},
    {kUpperLeg, "@UpLeg"}, {kLowerLeg, "@Leg"}, {kFoot, "@Foot"}, {kToes, "@ToeBase"}};

constexpr RoleNames kHumanIk[] = {
    {kRoot, "Reference"}, {kHips, "Hips"}, {kLegBase, "%HipJoint"}, {kTrunk, "Spine[#] LowerBack"}, {kNeck, "Neck[#]"},
    {kHead, "Head"}, {kTip, "HeadEnd Head_End @FootEnd @ToeEnd @Toe_End @HandEnd @HandIndex4 @HandMiddle4 @HandRing4 @HandPinky4 @HandThumb4"},
    {kEye, "@Eye"}, {kJaw, "Jaw"},
    {kCollar, "@Shoulder"}, {kUpperArm, "@Arm"}, {kUpperArm, "@ArmRoll[#]"}, {kLowerArm, "@ForeArm"}, {kLowerArm, "@ForeArmRoll[#]"},
    {kHand, "@Hand"}, {kHand, "@FingerBase"},
    {kThumb, "@HandThumb#"}, {kThumb, "%Thumb"}, {kPalm, "@InHandThumb @InHandIndex @InHandMiddle @InHandRing @InHandPinky"},
    {kIndex, "@HandIndex#"}, {kIndex, "@HandFinger1"}, {kMiddle, "@HandMiddle#"}, {kRing, "@HandRing#"}, {kLittle, "@HandPinky#"},
    {kUpperLeg, "@UpLeg"}, {kUpperLeg, "@UpLegRoll[#]"}, {kLowerLeg, "@Leg"}, {kLowerLeg, "@LegRoll[#]"}, {kFoot, "@Foot"},
    {kToes, "@ToeBase"}, {kToes, "@Toe"}};

constexpr RoleNames kUnreal[] = {
    {kRoot, "root"}, {kHips, "pelvis"}, {kTrunk, "spine_##"}, {kNeck, "neck_##"}, {kHead, "head"}, {kJaw, "jaw"}, {kEye, "eye_@"},
    {kCollar, "clavicle_@"}, {kUpperArm, "upperarm_@"}, {kUpperArm, "upperarm_twist_##_@"}, {kLowerArm, "lowerarm_@"},
    {kLowerArm, "lowerarm_twist_##_@"}, {kHand, "hand_@"},
    {kThumb, "thumb_##_@"}, {kIndex, "index_##_@"}, {kMiddle, "middle_##_@"}, {kRing, "ring_##_@"}, {kLittle, "pinky_##_@"},
    {kIndex, "index_metacarpal_@"}, {kMiddle, "middle_metacarpal_@"}, {kRing, "ring_metacarpal_@"}, {kLittle, "pinky_metacarpal_@"},
    {kUpperLeg, "thigh_@"}, {kUpperLeg, "thigh_twist_##_@"}, {kLowerLeg, "calf_@"}, {kLowerLeg, "calf_twist_##_@"}, {kFoot, "foot_@"},
    {kToes, "ball_@"}, {kTip, "ball_leaf_@ head_leaf thumb_04_leaf_@ index_04_leaf_@ middle_04_leaf_@ ring_04_leaf_@ pinky_04_leaf_@"},
    {kHelper, "ik_foot_root ik_foot_@ ik_hand_root ik_hand_gun ik_hand_@ interaction center_of_mass"}, {kAttachment, "weapon_@"}};

// MetaHuman's body has Unreal's names, and correctives at every joint.
constexpr RoleNames kCorrectives[] = {
    {kAttachment, "upperarm_correctiveRoot_@ lowerarm_correctiveRoot_@ thigh_correctiveRoot_@ calf_correctiveRoot_@ upperarm_bck_@ "
                  "upperarm_fwd_@ upperarm_in_@ upperarm_out_@ lowerarm_bck_@ lowerarm_fwd_@ lowerarm_in_@ lowerarm_out_@ thigh_bck_@ "
                  "thigh_fwd_@ thigh_in_@ thigh_out_@ thigh_bck_lwr_@ thigh_fwd_lwr_@ calf_knee_@ calf_kneeBack_@ "
                  "clavicle_pec_@ clavicle_out_@ clavicle_scap_@ spine_04_latissimus_@ upperarm_bicep_@ upperarm_tricep_@ upperarm_twistCor_##_@ "
                  "thigh_twistCor_##_@ calf_twistCor_##_@ ankle_bck_@ ankle_fwd_@ wrist_inner_@ wrist_outer_@"}};
constexpr auto kMetaHuman = joined(kUnreal, kCorrectives);

// VRM 1.0, and Godot's SkeletonProfileHumanoid (scene/resources/skeleton_profile.cpp), differ from Unity in the thumb.
constexpr RoleNames kHumanoidLimbs[] = {
    {kEye, "@Eye"}, {kCollar, "@Shoulder"}, {kUpperArm, "@UpperArm"}, {kLowerArm, "@LowerArm"}, {kHand, "@Hand"},
    {kUpperLeg, "@UpperLeg"}, {kLowerLeg, "@LowerLeg"}, {kFoot, "@Foot"}, {kToes, "@Toes"}};
constexpr RoleNames kHumanoidFingers[] = {
    {kIndex, "@IndexProximal @IndexIntermediate @IndexDistal"}, {kMiddle, "@MiddleProximal @MiddleIntermediate @MiddleDistal"},
    {kRing, "@RingProximal @RingIntermediate @RingDistal"}, {kLittle, "@LittleProximal @LittleIntermediate @LittleDistal"}};
constexpr RoleNames kHumanoidTrunk[] = {
    {kRoot, "Root"}, {kHips, "Hips"}, {kTrunk, "Spine Chest UpperChest"}, {kNeck, "Neck"}, {kHead, "Head"}, {kJaw, "Jaw"}};
constexpr RoleNames kUnityThumb[] = {{kThumb, "@ThumbProximal @ThumbIntermediate @ThumbDistal"}};
constexpr RoleNames kVrmThumb[] = {{kThumb, "@ThumbMetacarpal @ThumbProximal @ThumbDistal"}};
constexpr RoleNames kHumanoidVariants[] = {
    {kTrunk, "~Spine#"}, {kNeck, "~Neck[#]"}, {kToes, "~@ToeBase"}, {kThumb, "~@ThumbTip"}, {kIndex, "~@IndexMetacarpal ~@IndexTip"},
    {kMiddle, "~@MiddleMetacarpal ~@MiddleTip"}, {kRing, "~@RingMetacarpal ~@RingTip"}, {kLittle, "~@LittleMetacarpal ~@LittleTip"}};
constexpr RoleNames kVrmTrunk[] = {{kHips, "hips"}, {kTrunk, "spine chest upperChest"}, {kNeck, "neck"}, {kHead, "head"}, {kJaw, "jaw"}};
constexpr auto kUnity = joined(kHumanoidTrunk, kHumanoidLimbs, kUnityThumb, kHumanoidFingers, kHumanoidVariants);
constexpr auto kGodot = joined(kHumanoidTrunk, kHumanoidLimbs, kVrmThumb, kHumanoidFingers, kHumanoidVariants);
constexpr auto kVrm = joined(kVrmTrunk, kHumanoidLimbs, kVrmThumb, kHumanoidFingers, kHumanoidVariants);

constexpr RoleNames kUnitySuffixed[] = {
    {kRoot, "Root"}, {kHips, "Hips"}, {kTrunk, "Spine Chest UpperChest"}, {kTrunk, "Spine#"}, {kNeck, "Neck[#]"}, {kHead, "Head"},
    {kJaw, "Jaw"}, {kEye, "Eye_@"},
    {kCollar, "Shoulder_@"}, {kUpperArm, "UpperArm_@"}, {kLowerArm, "LowerArm_@"}, {kHand, "Hand_@"}, {kHand, "~Wrist_@"},
    {kThumb, "Thumb#_@"}, {kThumb, "ThumbProximal_@ ThumbIntermediate_@ ThumbDistal_@"},
    {kIndex, "Index#_@"}, {kIndex, "IndexProximal_@ IndexIntermediate_@ IndexDistal_@"},
    {kMiddle, "Middle#_@"}, {kMiddle, "MiddleProximal_@ MiddleIntermediate_@ MiddleDistal_@"},
    {kRing, "Ring#_@"}, {kRing, "RingProximal_@ RingIntermediate_@ RingDistal_@"},
    {kLittle, "Little#_@"}, {kLittle, "LittleProximal_@ LittleIntermediate_@ LittleDistal_@"},
    {kUpperLeg, "UpperLeg_@"}, {kLowerLeg, "LowerLeg_@"}, {kFoot, "Foot_@"}, {kToes, "Toes_@"}, {kToes, "ToeBase_@"}};

constexpr RoleNames kVroid[] = {
    {kHips, "C_Hips"}, {kTrunk, "C_Spine C_Chest C_UpperChest"}, {kNeck, "C_Neck"}, {kHead, "C_Head"},
    {kCollar, "@_Shoulder"}, {kUpperArm, "@_UpperArm"}, {kLowerArm, "@_LowerArm"}, {kHand, "@_Hand"},
    {kThumb, "@_Thumb#"}, {kIndex, "@_Index#"}, {kMiddle, "@_Middle#"}, {kRing, "@_Ring#"}, {kLittle, "@_Little#"},
    {kUpperLeg, "@_UpperLeg"}, {kLowerLeg, "@_LowerLeg"}, {kFoot, "@_Foot"}, {kToes, "@_ToeBase"}};

// Blender's metarigs and the deform bones of Rigify, which count from the hips to the head, as spine.003 is a chest in one
// rig and a neck in another. Other rigs have words for the trunk.
constexpr RoleNames kBlenderLimbs[] = {
    {kJaw, "jaw"}, {kEye, "eye.@"}, {kCollar, "shoulder.@"}, {kUpperArm, "upper_arm.@"}, {kLowerArm, "forearm.@"}, {kHand, "hand.@"},
    {kThumb, "thumb.##.@"}, {kIndex, "f_index.##.@"}, {kMiddle, "f_middle.##.@"}, {kRing, "f_ring.##.@"}, {kLittle, "f_pinky.##.@"},
    {kUpperLeg, "thigh.@"}, {kLowerLeg, "shin.@"}, {kFoot, "foot.@"}, {kToes, "toe.@"}};
constexpr RoleNames kBlenderTrunk[] = {{kHips, "hips"}, {kTrunk, "spine chest upper_chest"}, {kNeck, "neck"}, {kHead, "head"}};
constexpr RoleNames kRigifyOthers[] = {
    {kRoot, "root"}, {kSpineToHead, "spine[.###]"}, {kHips, "~hips"}, {kTrunk, "~chest ~upper_chest"}, {kNeck, "~neck[.###]"}, {kHead, "~head"},
    {kLegBase, "pelvis.@"}, {kAttachment, "breast.@"}, {kUpperArm, "upper_arm.@.###"}, {kLowerArm, "forearm.@.###"}, {kPalm, "palm.##.@"},
    {kUpperLeg, "thigh.@.###"}, {kLowerLeg, "shin.@.###"}, {kHelper, "heel.02.@"}};
constexpr auto kBlender = joined(kBlenderTrunk, kBlenderLimbs);
constexpr auto kRigify = joined(kBlenderLimbs, kRigifyOthers);

constexpr RoleNames kAutoRigPro[] = {
    {kRoot, "c_traj c_pos"}, {kHips, "root.x"}, {kTrunk, "spine_##.x"}, {kNeck, "neck.x"}, {kNeck, "subneck_#.x"}, {kHead, "head.x"},
    {kCollar, "shoulder.@"}, {kUpperArm, "arm_stretch.@"}, {kUpperArm, "arm_twist.@ arm_twist_2.@ arm.@"}, {kLowerArm, "forearm_stretch.@"},
    {kLowerArm, "forearm_twist.@ forearm_twist_2.@ forearm.@"}, {kHand, "hand.@"},
    {kThumb, "thumb#.@"}, {kThumb, "c_thumb#.@"}, {kIndex, "index#.@"}, {kIndex, "c_index#.@ index1_base.@ c_index1_base.@"},
    {kMiddle, "middle#.@"}, {kMiddle, "c_middle#.@ middle1_base.@ c_middle1_base.@"}, {kRing, "ring#.@"},
    {kRing, "c_ring#.@ ring1_base.@ c_ring1_base.@"}, {kLittle, "pinky#.@"}, {kLittle, "c_pinky#.@ pinky1_base.@ c_pinky1_base.@"},
    {kUpperLeg, "thigh_stretch.@"}, {kUpperLeg, "thigh_twist.@ thigh_twist_2.@ thigh.@"}, {kLowerLeg, "leg_stretch.@"},
    {kLowerLeg, "leg_twist.@ leg_twist_2.@ leg.@"}, {kFoot, "foot.@"}, {kToes, "toes_01.@"}, {kToes, "toes.@"},
    {kAttachment, "breast_##.@ c_breast_##.@ bot_bend.@ c_bot_bend.@"}};

// soupday/cc_blender_tools, rigify_mapping_data.py, has these beside Rigify's: DEF-spine.004 is CC_Base_NeckTwist01.
constexpr RoleNames kReallusion[] = {
    {kRoot, "=RL_BoneRoot BoneRoot"}, {kHips, "Hip"}, {kTrunk, "Waist Spine##"}, {kTrunk, "Pelvis"}, {kNeck, "NeckTwist##"}, {kHead, "Head"},
    {kJaw, "JawRoot"}, {kEye, "@_Eye"}, {kAttachment, "FacialBone UpperJaw Teeth01 Teeth02 Tongue##"},
    {kCollar, "@_Clavicle"}, {kUpperArm, "@_Upperarm"}, {kUpperArm, "@_UpperarmTwist##"}, {kLowerArm, "@_Forearm"},
    {kLowerArm, "@_ForearmTwist## @_ElbowShareBone"}, {kHand, "@_Hand"},
    {kThumb, "@_Thumb#"}, {kIndex, "@_Index#"}, {kMiddle, "@_Mid#"}, {kRing, "@_Ring#"}, {kLittle, "@_Pinky#"},
    {kUpperLeg, "@_Thigh"}, {kUpperLeg, "@_ThighTwist##"}, {kLowerLeg, "@_Calf"}, {kLowerLeg, "@_CalfTwist## @_KneeShareBone"},
    {kFoot, "@_Foot"}, {kToes, "@_ToeBase"}, {kToes, "@_BigToe# @_IndexToe# @_MidToe# @_RingToe# @_PinkyToe#"},
    {kAttachment, "@_RibsTwist @_Breast @_ToeBaseShareBone"}};

// Genesis 1 to 8, and Poser's people before them.
constexpr RoleNames kDaz[] = {
    {kHips, "hip"}, {kTrunk, "abdomenLower abdomenUpper chestLower chestUpper"}, {kTrunk, "pelvis abdomen abdomen2 chest"},
    {kNeck, "neckLower neckUpper"}, {kNeck, "neck"}, {kHead, "head"}, {kJaw, "lowerJaw"}, {kEye, "@Eye"},
    {kCollar, "@Collar"}, {kUpperArm, "@ShldrBend"}, {kUpperArm, "@ShldrTwist @Shldr"}, {kLowerArm, "@ForearmBend"},
    {kLowerArm, "@ForearmTwist @ForeArm"}, {kHand, "@Hand"}, {kPalm, "@Carpal#"},
    {kThumb, "@Thumb#"}, {kIndex, "@Index#"}, {kMiddle, "@Mid#"}, {kRing, "@Ring#"}, {kLittle, "@Pinky#"},
    {kLegBase, "@Buttock"}, {kUpperLeg, "@ThighBend"}, {kUpperLeg, "@ThighTwist @Thigh"}, {kLowerLeg, "@Shin"}, {kFoot, "@Foot"},
    {kFoot, "@Metatarsals"}, {kToes, "@Toe"}, {kAttachment, "@Pectoral"}};

constexpr RoleNames kGenesis9[] = {
    {kHips, "hip"}, {kTrunk, "spine#"}, {kTrunk, "pelvis"}, {kNeck, "neck#"}, {kHead, "head"}, {kJaw, "lowerjaw"}, {kEye, "@_eye"},
    {kCollar, "@_shoulder"}, {kUpperArm, "@_upperarm"}, {kUpperArm, "@_upperarmtwist#"}, {kLowerArm, "@_forearm"},
    {kLowerArm, "@_forearmtwist#"}, {kHand, "@_hand"},
    {kThumb, "@_thumb#"}, {kIndex, "@_index#"}, {kMiddle, "@_mid#"}, {kRing, "@_ring#"}, {kLittle, "@_pinky#"},
    {kIndex, "@_indexmetacarpal"}, {kMiddle, "@_midmetacarpal"}, {kRing, "@_ringmetacarpal"}, {kLittle, "@_pinkymetacarpal"},
    {kUpperLeg, "@_thigh"}, {kUpperLeg, "@_thightwist#"}, {kLowerLeg, "@_shin"}, {kFoot, "@_foot"}, {kFoot, "@_metatarsal"},
    {kToes, "@_toes"}, {kAttachment, "@_pectoral"}};

// 3ds Max's Biped, which carries the arms on the neck in its old figures, and Valve's characters.
constexpr RoleNames kBiped[] = {
    {kHips, "Pelvis"}, {kTrunk, "Spine[#]"}, {kNeck, "Neck[#]"}, {kHead, "Head[#]"},
    {kTip, "HeadNub @_Toe0Nub @_Finger0Nub @_Finger1Nub @_Finger2Nub @_Finger3Nub @_Finger4Nub"},
    {kCollar, "@_Clavicle"}, {kUpperArm, "@_UpperArm"}, {kUpperArm, "@UpArmTwist[#]"}, {kLowerArm, "@_Forearm"},
    {kLowerArm, "@_ForeTwist[#]"}, {kHand, "@_Hand"},
    {kThumb, "@_Finger0[#]"}, {kIndex, "@_Finger1[#]"}, {kMiddle, "@_Finger2[#]"}, {kRing, "@_Finger3[#]"}, {kLittle, "@_Finger4[#]"},
    {kUpperLeg, "@_Thigh"}, {kUpperLeg, "@ThighTwist[#]"}, {kLowerLeg, "@_Calf"}, {kLowerLeg, "@CalfTwist[#]"}, {kHock, "@_HorseLink"},
    {kFoot, "@_Foot"}, {kToes, "@_Toe0"}, {kToes, "@_Toe"}, {kTail, "Tail[#]"}, {kHair, "Ponytail1[#]"}};

// MakeHuman's default rig counts the joints of its spine from the neck down, and has five toes of their own.
constexpr RoleNames kMakeHuman[] = {
    {kHips, "root"}, {kTrunk, "spine##"}, {kNeck, "neck##"}, {kHead, "head"}, {kJaw, "jaw"}, {kEye, "eye.@"},
    {kCollar, "clavicle.@ shoulder01.@"}, {kUpperArm, "upperarm##.@"}, {kLowerArm, "lowerarm##.@"}, {kHand, "wrist.@"},
    {kPalm, "metacarpal#.@"},
    {kThumb, "finger1-#.@"}, {kIndex, "finger2-#.@"}, {kMiddle, "finger3-#.@"}, {kRing, "finger4-#.@"}, {kLittle, "finger5-#.@"},
    {kLegBase, "pelvis.@"}, {kUpperLeg, "upperleg##.@"}, {kLowerLeg, "lowerleg##.@"}, {kFoot, "foot.@"}, {kAttachment, "breast.@"}};

// The Acclaim files of the Carnegie Mellon motion capture database.
constexpr RoleNames kCmu[] = {
    {kHips, "root"}, {kTrunk, "lowerback upperback thorax"}, {kNeck, "lowerneck upperneck"}, {kHead, "head"},
    {kCollar, "@clavicle"}, {kUpperArm, "@humerus"}, {kLowerArm, "@radius"}, {kHand, "@wrist"}, {kHand, "@hand"},
    {kIndex, "@fingers"}, {kThumb, "@thumb"},
    {kLegBase, "@hipjoint"}, {kUpperLeg, "@femur"}, {kLowerLeg, "@tibia"}, {kFoot, "@foot"}, {kToes, "@toes"}};

constexpr RoleNames kRokoko[] = {
    {kHips, "Hips"}, {kTrunk, "Spine#"}, {kNeck, "Neck"}, {kHead, "Head"},
    {kCollar, "@Shoulder"}, {kUpperArm, "@Arm"}, {kLowerArm, "@ForeArm"}, {kHand, "@Hand"},
    {kThumb, "@Finger1Metacarpal @Finger1Proximal @Finger1Distal"}, {kIndex, "@Finger2Proximal @Finger2Medial @Finger2Distal"},
    {kMiddle, "@Finger3Proximal @Finger3Medial @Finger3Distal"}, {kRing, "@Finger4Proximal @Finger4Medial @Finger4Distal"},
    {kLittle, "@Finger5Proximal @Finger5Medial @Finger5Distal"}, {kIndex, "@Finger2Metacarpal"}, {kMiddle, "@Finger3Metacarpal"},
    {kRing, "@Finger4Metacarpal"}, {kLittle, "@Finger5Metacarpal"}, {kTip, "@Finger1Tip @Finger2Tip @Finger3Tip @Finger4Tip @Finger5Tip @ToeTip"},
    {kUpperLeg, "@Thigh"}, {kLowerLeg, "@Shin"}, {kFoot, "@Foot"}, {kToes, "@Toe"}};

constexpr RoleNames kXsens[] = {
    {kHips, "Pelvis"}, {kTrunk, "L5 L3 T12 T8"}, {kNeck, "Neck"}, {kHead, "Head"},
    {kCollar, "@Shoulder"}, {kUpperArm, "@UpperArm"}, {kLowerArm, "@ForeArm"}, {kHand, "@Hand"},
    {kUpperLeg, "@UpperLeg"}, {kLowerLeg, "@LowerLeg"}, {kFoot, "@Foot"}, {kToes, "@Toe"}};

// Kinect for Windows, and Azure Kinect.
constexpr RoleNames kKinect[] = {
    {kHips, "SpineBase"}, {kTrunk, "SpineMid SpineShoulder"}, {kNeck, "Neck"}, {kHead, "Head"},
    {kUpperArm, "Shoulder@"}, {kLowerArm, "Elbow@"}, {kHand, "Wrist@"}, {kHand, "Hand@"}, {kTip, "HandTip@"}, {kThumb, "Thumb@"},
    {kUpperLeg, "Hip@"}, {kLowerLeg, "Knee@"}, {kFoot, "Ankle@"}, {kToes, "Foot@"}};
constexpr RoleNames kAzureKinect[] = {
    {kHips, "PELVIS"}, {kTrunk, "SPINE_NAVEL SPINE_CHEST"}, {kNeck, "NECK"}, {kHead, "HEAD"}, {kEye, "EYE_@"}, {kEar, "EAR_@"}, {kAttachment, "NOSE"},
    {kCollar, "CLAVICLE_@"}, {kUpperArm, "SHOULDER_@"}, {kLowerArm, "ELBOW_@"}, {kHand, "WRIST_@"}, {kHand, "HAND_@"}, {kTip, "HANDTIP_@"},
    {kThumb, "THUMB_@"}, {kUpperLeg, "HIP_@"}, {kLowerLeg, "KNEE_@"}, {kFoot, "ANKLE_@"}, {kToes, "FOOT_@"}};

constexpr RoleNames kOptiTrack[] = {
    {kHips, "Hip"}, {kTrunk, "Ab Chest"}, {kNeck, "Neck[#]"}, {kHead, "Head"},
    {kCollar, "@Shoulder"}, {kUpperArm, "@UArm"}, {kLowerArm, "@FArm"}, {kHand, "@Hand"},
    {kThumb, "@Thumb#"}, {kIndex, "@Index#"}, {kMiddle, "@Middle#"}, {kRing, "@Ring#"}, {kLittle, "@Pinky#"},
    {kUpperLeg, "@Thigh"}, {kLowerLeg, "@Shin"}, {kFoot, "@Foot"}, {kToes, "@Toe"}};

constexpr RoleNames kSmpl[] = {
    {kHips, "Pelvis"}, {kTrunk, "Spine#"}, {kNeck, "Neck"}, {kHead, "Head"}, {kJaw, "Jaw"}, {kEye, "@_eye_smplhf"},
    {kCollar, "@_Collar"}, {kUpperArm, "@_Shoulder"}, {kLowerArm, "@_Elbow"}, {kHand, "@_Wrist"}, {kHand, "@_Hand"},
    {kThumb, "@_Thumb#"}, {kIndex, "@_Index#"}, {kMiddle, "@_Middle#"}, {kRing, "@_Ring#"}, {kLittle, "@_Pinky#"},
    {kUpperLeg, "@_Hip"}, {kLowerLeg, "@_Knee"}, {kFoot, "@_Ankle"}, {kToes, "@_Foot"}};

constexpr RoleNames kSecondLife[] = {
    {kHips, "mPelvis"}, {kTrunk, "mTorso mChest"}, {kTrunk, "mSpine#"}, {kNeck, "mNeck"}, {kHead, "mHead"}, {kTip, "mSkull"}, {kEye, "mEye@"},
    {kCollar, "mCollar@"}, {kUpperArm, "mShoulder@"}, {kLowerArm, "mElbow@"}, {kHand, "mWrist@"},
    {kThumb, "mHandThumb#@"}, {kIndex, "mHandIndex#@"}, {kMiddle, "mHandMiddle#@"}, {kRing, "mHandRing#@"}, {kLittle, "mHandPinky#@"},
    {kUpperLeg, "mHip@"}, {kLowerLeg, "mKnee@"}, {kFoot, "mAnkle@"}, {kFoot, "mFoot@"}, {kToes, "mToe@"}, {kTail, "mTail#"}};

constexpr RoleNames kArkit[] = {
    {kRoot, "root"}, {kHips, "hips_joint"}, {kTrunk, "spine_#_joint"}, {kNeck, "neck_#_joint"}, {kHead, "head_joint"}, {kJaw, "jaw_joint"},
    {kEye, "@_eye_joint"},
    {kCollar, "@_shoulder_1_joint"}, {kUpperArm, "@_arm_joint"}, {kLowerArm, "@_forearm_joint"}, {kHand, "@_hand_joint"},
    {kThumb, "@_handThumb_1_joint @_handThumb_2_joint"}, {kThumb, "@_handThumbStart_joint"}, {kTip, "@_handThumbEnd_joint @_toesEnd_joint"},
    {kIndex, "@_handIndex_#_joint"}, {kIndex, "@_handIndexStart_joint"}, {kMiddle, "@_handMid_#_joint"}, {kMiddle, "@_handMidStart_joint"},
    {kRing, "@_handRing_#_joint"}, {kRing, "@_handRingStart_joint"}, {kLittle, "@_handPinky_#_joint"}, {kLittle, "@_handPinkyStart_joint"},
    {kUpperLeg, "@_upLeg_joint"}, {kLowerLeg, "@_leg_joint"}, {kFoot, "@_foot_joint"}, {kToes, "@_toes_joint"}};

constexpr RoleNames kAdvancedSkeleton[] = {
    {kHips, "Root_M"}, {kTrunk, "Spine#_M"}, {kTrunk, "Chest_M BackA_M BackB_M RootPart#_M Spine#Part#_M"}, {kNeck, "Neck_M"},
    {kNeck, "NeckPart#_M"}, {kHead, "Head_M"}, {kJaw, "Jaw_M"}, {kEye, "Eye_@"}, {kTip, "HeadEnd_M ToesEnd_@ EyeEnd_@ JawEnd_M"},
    {kCollar, "Scapula_@"}, {kUpperArm, "Shoulder_@"}, {kUpperArm, "ShoulderPart#_@"}, {kLowerArm, "Elbow_@"}, {kLowerArm, "ElbowPart#_@"},
    {kHand, "Wrist_@"}, {kThumb, "ThumbFinger#_@"}, {kIndex, "IndexFinger#_@"}, {kMiddle, "MiddleFinger#_@"}, {kRing, "RingFinger#_@"},
    {kLittle, "PinkyFinger#_@"}, {kPalm, "Cup_@"},
    {kUpperLeg, "Hip_@"}, {kUpperLeg, "HipPart#_@"}, {kLowerLeg, "Knee_@"}, {kLowerLeg, "KneePart#_@"}, {kFoot, "Ankle_@"}, {kToes, "Toes_@"}};

// The 15 parts of the body; what else a character has is called by the joints of the class HumanoidRigDescription, fingers
// as Unity's.
constexpr RoleNames kRobloxBody[] = {
    {kRoot, "HumanoidRootPart HumanoidRootNode Root"}, {kHips, "LowerTorso"}, {kTrunk, "UpperTorso Chest UpperChest"},
    {kNeck, "Neck"}, {kHead, "Head"}, {kCollar, "@Clavicle"}, {kUpperArm, "@UpperArm"}, {kLowerArm, "@LowerArm"}, {kHand, "@Hand"},
    {kUpperLeg, "@UpperLeg"}, {kLowerLeg, "@LowerLeg"}, {kFoot, "@Foot"}, {kToes, "@ToeBase"}};
constexpr auto kRoblox = joined(kRobloxBody, kUnityThumb, kHumanoidFingers);

// MikuMikuDance: the upper and the lower body are two children of the waist or the center.
constexpr RoleNames kMmd[] = {
    {kRoot, "全ての親 操作中心"}, {kTrunk, "上半身[#]"}, {kTrunk, "センター グルーブ 腰"}, {kHips, "下半身"}, {kNeck, "首"}, {kHead, "頭"}, {kEye, "@目"},
    {kEye, "目.%"}, {kHelper, "両目 @足IK @つま先IK 足IK.% つま先IK.% @肩P 肩P.% @足IK親 足IK親.% @肩C 肩C.%"},
    {kCollar, "@肩"}, {kCollar, "肩.%"}, {kUpperArm, "@腕"}, {kUpperArm, "腕.% @腕捩[#] 腕捩.%"}, {kLowerArm, "@ひじ"},
    {kLowerArm, "ひじ.% @手捩[#] 手捩.%"}, {kHand, "@手首"}, {kHand, "手首.%"},
    {kThumb, "@親指#"}, {kThumb, "親指#.%"}, {kIndex, "@人指#"}, {kIndex, "人指#.% @人差指# 人差指#.%"}, {kMiddle, "@中指#"}, {kMiddle, "中指#.%"},
    {kRing, "@薬指#"}, {kRing, "薬指#.%"}, {kLittle, "@小指#"}, {kLittle, "小指#.%"},
    {kUpperLeg, "@足"}, {kUpperLeg, "足.%"}, {kLowerLeg, "@ひざ"}, {kLowerLeg, "ひざ.%"}, {kFoot, "@足首"}, {kFoot, "足首.%"},
    {kToes, "@つま先"}, {kToes, "つま先.%"}};
constexpr RoleNames kMmdEnglish[] = {
    {kTrunk, "upper_body[#]"}, {kTrunk, "center groove waist"}, {kHips, "lower_body"}, {kNeck, "neck"}, {kHead, "head"}, {kEye, "eye_@"},
    {kHelper, "eyes leg_IK_@ toe_IK_@ shoulderP_@ shoulderC_@"},
    {kCollar, "shoulder_@"}, {kUpperArm, "arm_@"}, {kUpperArm, "arm_twist[#]_@"}, {kLowerArm, "elbow_@"}, {kLowerArm, "wrist_twist[#]_@"},
    {kHand, "wrist_@"}, {kThumb, "thumb#_@"}, {kIndex, "fore#_@"}, {kMiddle, "middle#_@"}, {kRing, "third#_@"}, {kLittle, "little#_@"},
    {kUpperLeg, "leg_@"}, {kLowerLeg, "knee_@"}, {kFoot, "ankle_@"}, {kToes, "toe_@"}};

// SOMA's thigh is called leg; the first joint of each finger but the thumb is its metacarpal.
constexpr RoleNames kSoma[] = {
    {kRoot, "Root"}, {kHips, "Hips"}, {kTrunk, "Spine#"}, {kTrunk, "Chest"}, {kNeck, "Neck#"}, {kHead, "Head"}, {kJaw, "Jaw"}, {kEye, "@Eye"},
    {kTip, "HeadEnd @HandThumbEnd @HandIndexEnd @HandMiddleEnd @HandRingEnd @HandPinkyEnd @ToeEnd"},
    {kCollar, "@Shoulder"}, {kUpperArm, "@Arm"}, {kLowerArm, "@ForeArm"}, {kHand, "@Hand"},
    {kThumb, "@HandThumb#"}, {kIndex, "@HandIndex#"}, {kMiddle, "@HandMiddle#"}, {kRing, "@HandRing#"}, {kLittle, "@HandPinky#"},
    {kUpperLeg, "@Leg"}, {kLowerLeg, "@Shin"}, {kFoot, "@Foot"}, {kToes, "@ToeBase"}};

constexpr RoleNames kMhr[] = {
    {kRoot, "body_world"}, {kHips, "root"}, {kTrunk, "c_spine0 c_spine1 c_spine2 c_spine3"}, {kNeck, "c_neck"},
    {kNeck, "c_neck_twist0_proc c_neck_twist1_proc"}, {kHead, "c_head"}, {kJaw, "c_jaw"}, {kEye, "@_eye"},
    {kTip, "c_head_null c_jaw_null @_eye_null @_thumb_null @_index_null @_middle_null @_ring_null @_pinky_null"},
    {kCollar, "@_clavicle"}, {kUpperArm, "@_uparm"}, {kUpperArm, "@_uparm_twist#_proc"}, {kLowerArm, "@_lowarm"},
    {kLowerArm, "@_lowarm_twist#_proc @_wrist_twist"}, {kHand, "@_wrist"},
    {kThumb, "@_thumb#"}, {kIndex, "@_index#"}, {kMiddle, "@_middle#"}, {kRing, "@_ring#"}, {kLittle, "@_pinky#"},
    {kUpperLeg, "@_upleg"}, {kUpperLeg, "@_upleg_twist#_proc"}, {kLowerLeg, "@_lowleg"}, {kLowerLeg, "@_lowleg_twist#_proc"},
    {kFoot, "@_foot"}, {kFoot, "@_talocrural @_subtalar @_transversetarsal"}, {kToes, "@_ball"}};

// Motion files that name joints, not bones: the shoulder is where the upper arm begins.
constexpr RoleNames kJointNamed[] = {
    {kHips, "Hips"}, {kTrunk, "Chest[#]"}, {kTrunk, "Spine[#]"}, {kNeck, "Neck[#]"}, {kHead, "Head"},
    {kCollar, "@Collar"}, {kUpperArm, "@Shoulder"}, {kLowerArm, "@Elbow"}, {kHand, "@Wrist"}, {kHand, "@Hand"},
    {kUpperLeg, "@Hip"}, {kLowerLeg, "@Knee"}, {kFoot, "@Ankle"}, {kToes, "@Toe"}, {kToes, "@Toes"}};

constexpr RoleNames kMocopi[] = {
    {kHips, "root"}, {kTrunk, "torso_#"}, {kNeck, "neck_#"}, {kHead, "head"},
    {kCollar, "@_shoulder"}, {kUpperArm, "@_up_arm"}, {kLowerArm, "@_low_arm"}, {kHand, "@_hand"},
    {kUpperLeg, "@_up_leg"}, {kLowerLeg, "@_low_leg"}, {kFoot, "@_foot"}, {kToes, "@_toes"}};

constexpr RoleNames kWebXr[] = {
    {kHips, "hips"}, {kTrunk, "spine-lower spine-middle spine-upper chest"}, {kNeck, "neck"}, {kHead, "head"},
    {kCollar, "@-shoulder @-scapula"}, {kUpperArm, "@-arm-upper"}, {kLowerArm, "@-arm-lower"}, {kLowerArm, "@-hand-wrist-twist"},
    {kHand, "@-hand-wrist"}, {kHand, "@-hand-palm"},
    {kThumb, "@-hand-thumb-metacarpal @-hand-thumb-phalanx-proximal @-hand-thumb-phalanx-distal"},
    {kIndex, "@-hand-index-phalanx-proximal @-hand-index-phalanx-intermediate @-hand-index-phalanx-distal"}, {kIndex, "@-hand-index-metacarpal"},
    {kMiddle, "@-hand-middle-phalanx-proximal @-hand-middle-phalanx-intermediate @-hand-middle-phalanx-distal"}, {kMiddle, "@-hand-middle-metacarpal"},
    {kRing, "@-hand-ring-phalanx-proximal @-hand-ring-phalanx-intermediate @-hand-ring-phalanx-distal"}, {kRing, "@-hand-ring-metacarpal"},
    {kLittle, "@-hand-little-phalanx-proximal @-hand-little-phalanx-intermediate @-hand-little-phalanx-distal"}, {kLittle, "@-hand-little-metacarpal"},
    {kTip, "@-hand-thumb-tip @-hand-index-tip @-hand-middle-tip @-hand-ring-tip @-hand-little-tip"},
    {kUpperLeg, "@-upper-leg"}, {kLowerLeg, "@-lower-leg"}, {kLowerLeg, "@-foot-ankle-twist"}, {kFoot, "@-foot-ankle"},
    {kFoot, "@-foot-subtalar @-foot-transverse"}, {kToes, "@-foot-ball"}};

constexpr RoleNames kHorse[] = {
    {kRoot, "root"}, {kHips, "hips"}, {kTrunk, "spine_1 spine_2 spine_3 spine_4"}, {kTrunk, "ribcage_middle ribcage_leaf ribcage_front ribcage_front_leaf"},
    {kNeck, "spine_5 spine_6"}, {kHead, "head"}, {kJaw, "mouth"}, {kEar, "ear_#_@"}, {kTail, "tail_#"},
    {kTip, "head_leaf mouth_tip ear_leaf_@ tail_leaf front_leg_leaf_@ back_leg_leaf_@ nose"},
    {kLegBase, "front_scapula_@", 0}, {kUpperLeg, "front_humerus_@", 0}, {kLowerLeg, "front_leg_upper_@", 0}, {kHock, "front_leg_lower_@", 0},
    {kFoot, "front_leg_ankle_@", 0}, {kToes, "front_leg_foot_@", 0},
    {kLegBase, "back_leg_pelvis_@", 1}, {kUpperLeg, "back_leg_upper_@", 1}, {kLowerLeg, "back_leg_lower_@", 1}, {kHock, "back_leg_ankle_@", 1},
    {kFoot, "back_leg_foot_@", 1}, {kToes, "back_leg_toe_@", 1}};
constexpr RoleNames kFox[] = {
    {kRoot, "root"}, {kHips, "Hips"}, {kTrunk, "Spine_1 Spine_2 Spine_2.001"}, {kTrunk, "Stomach Stomach_tip"}, {kNeck, "Spine_3 Spine_4"},
    {kHead, "Head"}, {kJaw, "Chin"}, {kEar, "Ear_@"}, {kTail, "Tail_Base Tail_Mid Tail_Mid.001 Tail_End Tail_Tip"},
    {kTip, "Nose Head.tip Chin_Tip Ear_Tip_@ Front_Leg_Tip_@ Back_Leg_Tip_@"},
    {kLegBase, "Front_Leg_Shoulder_@", 0}, {kUpperLeg, "Front_Leg_Upper_@", 0}, {kLowerLeg, "Front_Leg_Lower_@", 0},
    {kFoot, "Front_Leg_Ankle_@", 0}, {kToes, "Front_Leg_Foot_@", 0},
    {kLegBase, "Back_Leg_Pelvis_@", 1}, {kUpperLeg, "Back_Leg_Upper_@", 1}, {kLowerLeg, "Back_Leg_Lower_@", 1}, {kHock, "Back_Leg_Ankle_@", 1},
    {kFoot, "Back_Leg_Foot_@", 1}, {kToes, "Back_Leg_Foot_1_@", 1}};
// clang-format on

// Of two that name as many joints the first is taken.
// clang-format off
constexpr NamingConvention kConventions[] = {
    {"Mixamo", "mixamorig:", {"Left", "Right"}, {}, kMixamo, "https://helpx.adobe.com/creative-cloud/help/mixamo-rigging-animation.html"},
    {"MotionBuilder", "", {"Left", "Right"}, {"L", "R"}, kHumanIk, "https://help.autodesk.com/view/MOBPRO/2024/ENU/"},
    {"Unreal", "", {"l", "r"}, {}, kUnreal, "https://dev.epicgames.com/documentation/en-us/unreal-engine/skeletons-in-unreal-engine"},
    {"MetaHuman", "", {"l", "r"}, {}, kMetaHuman, "https://dev.epicgames.com/documentation/en-us/metahuman"},
    {"Unity", "", {"Left", "Right"}, {}, kUnity, "https://docs.unity3d.com/ScriptReference/HumanBodyBones.html"},
    {"VRM", "", {"left", "right"}, {}, kVrm, "https://github.com/vrm-c/vrm-specification: specification/VRMC_vrm-1.0/humanoid.md"},
    {"Godot", "", {"Left", "Right"}, {}, kGodot, "https://docs.godotengine.org/en/stable/classes/class_skeletonprofilehumanoid.html"},
    {"Unity, sides behind", "", {"L", "R"}, {}, kUnitySuffixed, "https://docs.unity3d.com/ScriptReference/HumanBodyBones.html"},
    {"VRoid", "J_Bip_", {"L", "R"}, {}, kVroid, "https://vroid.com/en/studio"},
    {"Blender", "", {"L", "R"}, {}, kBlender, "https://docs.blender.org/manual/en/latest/animation/armatures/bones/editing/naming.html"},
    {"Rigify", "DEF-", {"L", "R"}, {}, kRigify, "https://docs.blender.org/manual/en/latest/addons/rigging/rigify/"},
    {"Auto-Rig Pro", "", {"l", "r"}, {}, kAutoRigPro, "https://www.lucky3d.fr/auto-rig-pro/doc/"},
    {"Character Creator", "CC_Base_", {"L", "R"}, {}, kReallusion, "https://manual.reallusion.com/Character-Creator-4/"},
    {"Daz Genesis", "", {"l", "r"}, {}, kDaz, "http://docs.daz3d.com/"},
    {"Daz Genesis 9", "", {"l", "r"}, {}, kGenesis9, "http://docs.daz3d.com/"},
    {"3ds Max Biped", "Bip01 ", {"L", "R"}, {}, kBiped, "https://help.autodesk.com/view/3DSMAX/2024/ENU/", TorsoTree::kArmsOnNeck},
    {"MakeHuman", "", {"L", "R"}, {}, kMakeHuman, "https://github.com/makehumancommunity/makehuman: makehuman/data/rigs/default.mhskel"},
    {"CMU", "", {"l", "r"}, {}, kCmu, "http://mocap.cs.cmu.edu/"},
    {"Rokoko", "", {"Left", "Right"}, {}, kRokoko, "https://support.rokoko.com/"},
    {"Xsens", "", {"Left", "Right"}, {}, kXsens, "https://base.movella.com/"},
    {"Kinect", "", {"Left", "Right"}, {}, kKinect, "https://learn.microsoft.com/en-us/previous-versions/windows/kinect/"},
    {"Azure Kinect", "", {"LEFT", "RIGHT"}, {}, kAzureKinect, "https://learn.microsoft.com/en-us/azure/kinect-dk/body-joints"},
    {"OptiTrack", "", {"L", "R"}, {}, kOptiTrack, "https://docs.optitrack.com/"},
    {"SMPL", "", {"L", "R"}, {}, kSmpl, "https://github.com/vchoutas/smplx: smplx/joint_names.py"},
    {"SMPL-X", "", {"left", "right"}, {}, kSmpl, "https://github.com/vchoutas/smplx: smplx/joint_names.py"},
    {"Second Life", "", {"Left", "Right"}, {}, kSecondLife, "https://wiki.secondlife.com/wiki/Project_Bento_Skeleton_Guide"},
    {"ARKit", "", {"left", "right"}, {}, kArkit, "https://developer.apple.com/documentation/arkit/arskeletondefinition"},
    {"Advanced Skeleton", "", {"L", "R"}, {}, kAdvancedSkeleton, "https://www.animationstudios.com.au/advanced-skeleton"},
    {"SOMA", "", {"Left", "Right"}, {}, kSoma, "https://github.com/nv-tlabs/kimodo: kimodo/skeleton/definitions.py"},
    {"MHR", "", {"l", "r"}, {}, kMhr, "https://github.com/facebookresearch/MHR"},
    {"joint-named BVH", "", {"Left", "Right"}, {}, kJointNamed, "https://research.cs.wisc.edu/graphics/Courses/cs-838-1999/Jeff/BVH.html"},
    {"mocopi", "", {"l", "r"}, {}, kMocopi, "https://www.sony.net/Products/mocopi-dev/en/documents/Home/TechSpec.html"},
    {"WebXR", "", {"left", "right"}, {}, kWebXr, "https://immersive-web.github.io/body-tracking/"},
    {"Roblox R15", "", {"Left", "Right"}, {}, kRoblox, "https://create.roblox.com/docs/art/characters/specifications"},
    {"MikuMikuDance", "", {"左", "右"}, {"L", "R"}, kMmd, "https://github.com/MMD-Blender/blender_mmd_tools", TorsoTree::kLowerBodyBeside},
    {"MikuMikuDance in English", "", {"L", "R"}, {}, kMmdEnglish, "https://github.com/MMD-Blender/blender_mmd_tools", TorsoTree::kLowerBodyBeside},
    {"Mesh2Motion horse", "", {"l", "r"}, {}, kHorse, "https://mesh2motion.org"},
    {"Mesh2Motion fox", "", {"L", "R"}, {}, kFox, "https://mesh2motion.org"},
};
// clang-format on

}  // namespace

std::span<const NamingConvention> namingConventions() {
  return kConventions;
}

}  // namespace limber
