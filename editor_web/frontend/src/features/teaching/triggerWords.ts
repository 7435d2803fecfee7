/** What triggers are and do, in words. */
import type { Trigger } from '../../api/types'

export const TYPE_WORDS: Readonly<Record<Trigger['trig_type'], string>> = {
  rising_edge: 'when pressed',
  falling_edge: 'when let go',
  hold: 'while held',
}

export const CALLBACK_WORDS: Readonly<Record<Trigger['trig_callback'], string>> = {
  joint_save: 'captures the joints',
  pose_save: 'captures the pose',
  tf_save: 'captures a frame',
  gripper_save: 'captures the grip',
  joint_dmp_save: 'records, in joints',
  cart_dmp_save: 'records the tool',
  grav_comp: 'lets it float',
}
