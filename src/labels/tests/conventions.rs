//! Ways to name joints: the names are those of the programs, the skeletons are cut down to what matters.

use super::{limbs, skeleton};
use crate::labels::Anatomy;
use crate::labels::skeleton::label_skeleton;
use crate::mocap::{JointId, Skeleton};

/// Limbs as `left upper, lower, end; right …` arms first, and hips, chest, neck and head.
pub(super) fn check(names: &str, arms_and_legs: &str, trunk: [&str; 4]) -> (Skeleton, Anatomy) {
    let skeleton = skeleton(names);
    let anatomy = label_skeleton(&skeleton);
    let expected: Vec<Vec<&str>> = arms_and_legs
        .split(';')
        .map(|limb| limb.split(',').map(str::trim).collect())
        .collect();
    assert_eq!(limbs(&skeleton, &anatomy), expected, "limbs of {names}");
    let name =
        |joint: Option<JointId>| joint.map_or("", |joint| skeleton.joints[joint].name.as_str());
    let found = [
        name(anatomy.hips),
        name(anatomy.chest()),
        name(anatomy.neck.first().copied()),
        name(anatomy.head),
    ];
    assert_eq!(found, trunk, "trunk of {names}");
    (skeleton, anatomy)
}

#[test]
fn mixamo() {
    check(
        "
mixamorig:Hips
 mixamorig:Spine
  mixamorig:Spine1
   mixamorig:Spine2
    mixamorig:Neck
     mixamorig:Head
      mixamorig:HeadTop_End
    mixamorig:LeftShoulder
     mixamorig:LeftArm
      mixamorig:LeftForeArm
       mixamorig:LeftHand
        mixamorig:LeftHandThumb1
        mixamorig:LeftHandMiddle1
    mixamorig:RightShoulder
     mixamorig:RightArm
      mixamorig:RightForeArm
       mixamorig:RightHand
 mixamorig:LeftUpLeg
  mixamorig:LeftLeg
   mixamorig:LeftFoot
    mixamorig:LeftToeBase
     mixamorig:LeftToe_End
 mixamorig:RightUpLeg
  mixamorig:RightLeg
   mixamorig:RightFoot
    mixamorig:RightToeBase",
        "mixamorig:LeftArm, mixamorig:LeftForeArm, mixamorig:LeftHand; mixamorig:RightArm, mixamorig:RightForeArm, \
         mixamorig:RightHand; mixamorig:LeftUpLeg, mixamorig:LeftLeg, mixamorig:LeftFoot; mixamorig:RightUpLeg, \
         mixamorig:RightLeg, mixamorig:RightFoot",
        [
            "mixamorig:Hips",
            "mixamorig:Spine2",
            "mixamorig:Neck",
            "mixamorig:Head",
        ],
    );
}

#[test]
fn twist_and_roll_joints_of_motionbuilder() {
    check(
        "
Hips
 Spine
  LeftShoulder
   LeftArm
    LeftArmRoll
     LeftForeArm
      LeftForeArmRoll
       LeftHand
  RightShoulder
   RightArm
    RightArmRoll
    RightForeArm
     RightHand
  Neck
   Head
 LeftUpLeg
  LeftUpLegRoll
  LeftLeg
   LeftFoot
 RightUpLeg
  RightLeg
   RightFoot",
        "LeftArm, LeftForeArm, LeftHand; RightArm, RightForeArm, RightHand; LeftUpLeg, LeftLeg, LeftFoot; RightUpLeg, RightLeg, RightFoot",
        ["Hips", "Spine", "Neck", "Head"],
    );
}

#[test]
fn cmu() {
    let (skeleton, anatomy) = check(
        "
Hips
 LHipJoint
  LeftUpLeg
   LeftLeg
    LeftFoot
     LeftToeBase
 RHipJoint
  RightUpLeg
   RightLeg
    RightFoot
     RightToeBase
 LowerBack
  Spine
   Spine1
    Neck
     Neck1
      Head
    LeftShoulder
     LeftArm
      LeftForeArm
       LeftHand
        LeftFingerBase
         LeftHandIndex1
        LThumb
    RightShoulder
     RightArm
      RightForeArm
       RightHand
        RightFingerBase
        RThumb",
        "LeftArm, LeftForeArm, LeftHand; RightArm, RightForeArm, RightHand; LeftUpLeg, LeftLeg, LeftFoot; RightUpLeg, RightLeg, RightFoot",
        ["Hips", "Spine1", "Neck", "Head"],
    );
    assert_eq!(anatomy.spine.len(), 3);
    assert_eq!(anatomy.neck.len(), 2);
    let thumb = skeleton
        .joints
        .position(|joint| joint.name == "LThumb")
        .unwrap();
    assert_eq!(anatomy.labels[thumb], None);
}

#[test]
fn acclaim() {
    check(
        "
root
 lhipjoint
  lfemur
   ltibia
    lfoot
     ltoes
 rhipjoint
  rfemur
   rtibia
    rfoot
 lowerback
  upperback
   thorax
    lowerneck
     upperneck
      head
    lclavicle
     lhumerus
      lradius
       lwrist
        lhand
         lfingers
        lthumb
    rclavicle
     rhumerus
      rradius
       rwrist
        rhand",
        "lhumerus, lradius, lwrist; rhumerus, rradius, rwrist; lfemur, ltibia, lfoot; rfemur, rtibia, rfoot",
        ["root", "thorax", "lowerneck", "head"],
    );
}

#[test]
fn biovision_and_poser() {
    check(
        "
Hips
 LeftHip
  LeftKnee
   LeftAnkle
    LeftToe
 RightHip
  RightKnee
   RightAnkle
 Chest
  LeftCollar
   LeftShoulder
    LeftElbow
     LeftWrist
  RightCollar
   RightShoulder
    RightElbow
     RightWrist
  Neck
   Head",
        "LeftShoulder, LeftElbow, LeftWrist; RightShoulder, RightElbow, RightWrist; LeftHip, LeftKnee, LeftAnkle; RightHip, RightKnee, RightAnkle",
        ["Hips", "Chest", "Neck", "Head"],
    );
    check(
        "
hip
 abdomen
  chest
   neck
    head
     leftEye
   rCollar
    rShldr
     rForeArm
      rHand
       rMid1
   lCollar
    lShldr
     lForeArm
      lHand
 rButtock
  rThigh
   rShin
    rFoot
 lButtock
  lThigh
   lShin
    lFoot",
        "lShldr, lForeArm, lHand; rShldr, rForeArm, rHand; lThigh, lShin, lFoot; rThigh, rShin, rFoot",
        ["hip", "chest", "neck", "head"],
    );
}

#[test]
fn necks_of_iclone_are_named_after_twists() {
    check(
        "
CC_Base_BoneRoot
 CC_Base_Hip
  CC_Base_Pelvis
   CC_Base_L_Thigh
    CC_Base_L_ThighTwist01
    CC_Base_L_Calf
     CC_Base_L_CalfTwist01
     CC_Base_L_Foot
      CC_Base_L_ToeBase
   CC_Base_R_Thigh
    CC_Base_R_Calf
     CC_Base_R_Foot
      CC_Base_R_ToeBase
  CC_Base_Waist
   CC_Base_Spine01
    CC_Base_Spine02
     CC_Base_NeckTwist01
      CC_Base_NeckTwist02
       CC_Base_Head
     CC_Base_L_Clavicle
      CC_Base_L_Upperarm
       CC_Base_L_UpperarmTwist01
       CC_Base_L_Forearm
        CC_Base_L_Hand
     CC_Base_R_Clavicle
      CC_Base_R_Upperarm
       CC_Base_R_Forearm
        CC_Base_R_Hand",
        "CC_Base_L_Upperarm, CC_Base_L_Forearm, CC_Base_L_Hand; CC_Base_R_Upperarm, CC_Base_R_Forearm, CC_Base_R_Hand; \
         CC_Base_L_Thigh, CC_Base_L_Calf, CC_Base_L_Foot; CC_Base_R_Thigh, CC_Base_R_Calf, CC_Base_R_Foot",
        [
            "CC_Base_Pelvis",
            "CC_Base_Spine02",
            "CC_Base_NeckTwist01",
            "CC_Base_Head",
        ],
    );
}
