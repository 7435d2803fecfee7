/** Shows what is being taught in the 3D view of this page, until something else is or the wizard ends. */
import { useEffect } from 'react'
import { clearTeachRefusal, sendToServer, useTeach } from '../../api/teaching'
import type { Dict } from '../../document/dict'
import type { PlacedPose, Vector } from '../../document/poses'

/** The arm at a value of a kind, or at a named entry of it. */
export interface Ghost {
  readonly kind: string
  readonly name: string
  readonly value: Dict<unknown> | null
}

export type ShownValue =
  | { readonly kind: 'pose'; readonly pose: PlacedPose }
  | { readonly kind: 'joints'; readonly joints: readonly number[] }
  | { readonly kind: 'points'; readonly points: readonly Vector[] }
  | { readonly kind: 'waypoints'; readonly points: readonly Vector[]; readonly ghost: Ghost | undefined }
  | { readonly kind: 'box'; readonly low: Vector; readonly high: Vector }

/** Values that follow one another fast are not all shown: the arm would be looked for at each. */
const PAUSE_MS = 200
const NOTHING = { k: 'look', arm: '', kind: '', name: '', capture: 0, revision: 0, place: 0 } as const
const NO_MARKS = { k: 'mark', points: [], box: null, axes: null } as const

export function useShownValue(arm: string, value: ShownValue | undefined): void {
  const isOpen = useTeach((s) => s.isOpen && s.arms !== undefined)
  const written = JSON.stringify(value ?? null)
  useEffect(() => {
    if (!isOpen) return
    const timer = setTimeout(() => show(arm, JSON.parse(written) as ShownValue | null), PAUSE_MS)
    return () => clearTimeout(timer)
  }, [isOpen, arm, written])
  useEffect(() => () => show('', null), [])
}

function show(arm: string, value: ShownValue | null): void {
  const ghost = value && ghostOf(value)
  clearTeachRefusal('look')
  sendToServer(ghost && arm ? { ...NOTHING, arm, ...ghost } : NOTHING)
  switch (value?.kind) {
    case 'pose':
      return sendToServer({ ...NO_MARKS, axes: [value.pose.xyz, value.pose.xyzw] })
    case 'points':
    case 'waypoints':
      return sendToServer({ ...NO_MARKS, points: value.points })
    case 'box':
      return sendToServer({ ...NO_MARKS, box: [value.low, value.high] })
    default:
      return sendToServer(NO_MARKS)
  }
}

function ghostOf(value: ShownValue): Ghost | undefined {
  switch (value.kind) {
    case 'pose':
      return { kind: 'pose', name: '', value: { ...value.pose, frame: 'world' } }
    case 'joints':
      return { kind: 'joints', name: '', value: { joints: value.joints } }
    case 'waypoints':
      return value.ghost
    default:
      return undefined
  }
}
