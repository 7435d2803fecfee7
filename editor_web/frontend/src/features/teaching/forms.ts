/** The forms in which something taught is kept, in words. */
import type { CaptureSummary } from '../../api/types'

export type Form = CaptureSummary['form']

/** What an arm can carry out. */
export const PLAYED: ReadonlySet<string> = new Set(['joints', 'pose', 'dmp', 'cart_dmp', 'trajectory'])

export const FORM_WORDS: Readonly<Record<Form, string>> = {
  joints: 'Joints',
  pose: 'Pose',
  dmp: 'Motion, joints',
  cart_dmp: 'Motion, tool',
  trajectory: 'Recording',
  gripper: 'Grip',
}

/** What a capture can be saved as, the usual form first. */
export function formsOf(capture: CaptureSummary): readonly Form[] {
  if (capture.form === 'gripper') return ['gripper']
  const all: readonly Form[] = capture.samples > 0 ? ['dmp', 'cart_dmp', 'trajectory', 'joints', 'pose'] : ['joints', 'pose']
  return [capture.form, ...all.filter((form) => form !== capture.form)]
}
