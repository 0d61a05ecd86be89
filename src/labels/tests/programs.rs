//! Ways to name joints, continued: game engines, modellers, cameras.

use super::conventions::check;

#[test]
fn unreal() {
    check(
        "
root
 pelvis
  spine_01
   spine_02
    spine_03
     clavicle_l
      upperarm_l
       lowerarm_l
        hand_l
         middle_01_l
        lowerarm_twist_01_l
       upperarm_twist_01_l
     clavicle_r
      upperarm_r
       lowerarm_r
        hand_r
     neck_01
      head
  thigh_l
   calf_l
    foot_l
     ball_l
    calf_twist_01_l
  thigh_r
   calf_r
    foot_r
 ik_foot_root
  ik_foot_l
  ik_foot_r
 ik_hand_root
  ik_hand_gun",
        "upperarm_l, lowerarm_l, hand_l; upperarm_r, lowerarm_r, hand_r; thigh_l, calf_l, foot_l; thigh_r, calf_r, foot_r",
        ["pelvis", "spine_03", "neck_01", "head"],
    );
}

#[test]
fn vrm() {
    check(
        "
Root
 J_Bip_C_Hips
  J_Bip_C_Spine
   J_Bip_C_Chest
    J_Bip_C_UpperChest
     J_Bip_C_Neck
      J_Bip_C_Head
       J_Adj_L_FaceEye
       J_Sec_Hair1_01
     J_Bip_L_Shoulder
      J_Bip_L_UpperArm
       J_Bip_L_LowerArm
        J_Bip_L_Hand
     J_Bip_R_Shoulder
      J_Bip_R_UpperArm
       J_Bip_R_LowerArm
        J_Bip_R_Hand
  J_Bip_L_UpperLeg
   J_Bip_L_LowerLeg
    J_Bip_L_Foot
     J_Bip_L_ToeBase
  J_Bip_R_UpperLeg
   J_Bip_R_LowerLeg
    J_Bip_R_Foot",
        "J_Bip_L_UpperArm, J_Bip_L_LowerArm, J_Bip_L_Hand; J_Bip_R_UpperArm, J_Bip_R_LowerArm, J_Bip_R_Hand; \
         J_Bip_L_UpperLeg, J_Bip_L_LowerLeg, J_Bip_L_Foot; J_Bip_R_UpperLeg, J_Bip_R_LowerLeg, J_Bip_R_Foot",
        [
            "J_Bip_C_Hips",
            "J_Bip_C_UpperChest",
            "J_Bip_C_Neck",
            "J_Bip_C_Head",
        ],
    );
}

#[test]
fn rigify_has_no_head_by_name_and_runs_of_numbers() {
    check(
        "
DEF-spine
 DEF-pelvis.L
 DEF-pelvis.R
 DEF-thigh.L
  DEF-thigh.L.001
   DEF-shin.L
    DEF-shin.L.001
     DEF-foot.L
      DEF-toe.L
 DEF-thigh.R
  DEF-thigh.R.001
   DEF-shin.R
    DEF-shin.R.001
     DEF-foot.R
      DEF-toe.R
 DEF-spine.001
  DEF-spine.002
   DEF-spine.003
    DEF-spine.004
     DEF-spine.005
      DEF-spine.006
    DEF-shoulder.L
     DEF-upper_arm.L
      DEF-upper_arm.L.001
       DEF-forearm.L
        DEF-forearm.L.001
         DEF-hand.L
    DEF-shoulder.R
     DEF-upper_arm.R
      DEF-upper_arm.R.001
       DEF-forearm.R
        DEF-forearm.R.001
         DEF-hand.R",
        "DEF-upper_arm.L, DEF-forearm.L, DEF-hand.L; DEF-upper_arm.R, DEF-forearm.R, DEF-hand.R; DEF-thigh.L, DEF-shin.L, DEF-foot.L; \
         DEF-thigh.R, DEF-shin.R, DEF-foot.R",
        [
            "DEF-spine",
            "DEF-spine.003",
            "DEF-spine.004",
            "DEF-spine.006",
        ],
    );
}

#[test]
fn mikumikudance() {
    check(
        "
センター
 上半身
  上半身2
   首
    頭
     左目
   左肩
    左腕
     左腕捩
      左ひじ
       左手捩
        左手首
         左親指１
   右肩
    右腕
     右ひじ
      右手首
       右中指１
 下半身
  左足
   左ひざ
    左足首
     左つま先
  右足
   右ひざ
    右足首
 左足ＩＫ",
        "左腕, 左ひじ, 左手首; 右腕, 右ひじ, 右手首; 左足, 左ひざ, 左足首; 右足, 右ひざ, 右足首",
        ["下半身", "上半身2", "首", "頭"],
    );
}

#[test]
fn kinect() {
    check(
        "
SpineBase
 SpineMid
  SpineShoulder
   Neck
    Head
   ShoulderLeft
    ElbowLeft
     WristLeft
      HandLeft
       HandTipLeft
      ThumbLeft
   ShoulderRight
    ElbowRight
     WristRight
      HandRight
 HipLeft
  KneeLeft
   AnkleLeft
    FootLeft
 HipRight
  KneeRight
   AnkleRight
    FootRight",
        "ShoulderLeft, ElbowLeft, WristLeft; ShoulderRight, ElbowRight, WristRight; HipLeft, KneeLeft, AnkleLeft; HipRight, KneeRight, AnkleRight",
        ["SpineBase", "SpineShoulder", "Neck", "Head"],
    );
}

#[test]
fn optitrack_and_xsens() {
    check(
        "
Hip
 Ab
  Chest
   Neck
    Head
   LShoulder
    LUArm
     LFArm
      LHand
   RShoulder
    RUArm
     RFArm
      RHand
 LThigh
  LShin
   LFoot
    LToe
 RThigh
  RShin
   RFoot
    RToe",
        "LUArm, LFArm, LHand; RUArm, RFArm, RHand; LThigh, LShin, LFoot; RThigh, RShin, RFoot",
        ["Hip", "Chest", "Neck", "Head"],
    );
    check(
        "
Pelvis
 L5
  L3
   T12
    T8
     Neck
      Head
     RightShoulder
      RightUpperArm
       RightForearm
        RightHand
     LeftShoulder
      LeftUpperArm
       LeftForearm
        LeftHand
 RightUpperLeg
  RightLowerLeg
   RightFoot
    RightToe
 LeftUpperLeg
  LeftLowerLeg
   LeftFoot",
        "LeftUpperArm, LeftForearm, LeftHand; RightUpperArm, RightForearm, RightHand; LeftUpperLeg, LeftLowerLeg, LeftFoot; \
         RightUpperLeg, RightLowerLeg, RightFoot",
        ["Pelvis", "T8", "Neck", "Head"],
    );
}

#[test]
fn accad_and_makehuman() {
    check(
        "
Hips
 ToSpine
  Spine
   Spine1
    Neck
     Head
    LeftShoulder
     LeftUpArm
      LeftLowArm
       LeftHand
    RightShoulder
     RightUpArm
      RightLowArm
       RightHand
 LeftUpLeg
  LeftLowLeg
   LeftFoot
 RightUpLeg
  RightLowLeg
   RightFoot",
        "LeftUpArm, LeftLowArm, LeftHand; RightUpArm, RightLowArm, RightHand; LeftUpLeg, LeftLowLeg, LeftFoot; RightUpLeg, RightLowLeg, RightFoot",
        ["Hips", "Spine1", "Neck", "Head"],
    );
    check(
        "
Root
 Spine1
  Spine2
   Neck
    Head
   __Clavicle_L
    Clavicle_L
     UpArm_L
      LoArm_L
       Hand_L
   __Clavicle_R
    Clavicle_R
     UpArm_R
      LoArm_R
       Hand_R
 Hips
  __UpLeg_L
   UpLeg_L
    LoLeg_L
     Foot_L
      Toe_L
  __UpLeg_R
   UpLeg_R
    LoLeg_R
     Foot_R",
        "UpArm_L, LoArm_L, Hand_L; UpArm_R, LoArm_R, Hand_R; UpLeg_L, LoLeg_L, Foot_L; UpLeg_R, LoLeg_R, Foot_R",
        ["Hips", "Spine2", "Neck", "Head"],
    );
}

#[test]
fn biped_hangs_collars_on_the_neck() {
    check(
        "
Bip01
 Bip01 Pelvis
  Bip01 Spine
   Bip01 Spine1
    Bip01 Neck
     Bip01 Head
      Bip01 HeadNub
     Bip01 L Clavicle
      Bip01 L UpperArm
       Bip01 L Forearm
        Bip01 L Hand
         Bip01 L Finger0
     Bip01 R Clavicle
      Bip01 R UpperArm
       Bip01 R Forearm
        Bip01 R Hand
  Bip01 L Thigh
   Bip01 L Calf
    Bip01 L Foot
     Bip01 L Toe0
  Bip01 R Thigh
   Bip01 R Calf
    Bip01 R Foot",
        "Bip01 L UpperArm, Bip01 L Forearm, Bip01 L Hand; Bip01 R UpperArm, Bip01 R Forearm, Bip01 R Hand; Bip01 L Thigh, Bip01 L Calf, \
         Bip01 L Foot; Bip01 R Thigh, Bip01 R Calf, Bip01 R Foot",
        ["Bip01 Pelvis", "Bip01 Spine1", "Bip01 Neck", "Bip01 Head"],
    );
}
