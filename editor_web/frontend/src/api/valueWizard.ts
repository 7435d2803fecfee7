/** What somebody wants to teach or to choose on the cell, for a value of the document. */
import { pageStore } from './pageStore'
import type { EntryName } from './types'

interface Request {
  /** What is set, for its title: `target of pick`. */
  readonly title: string
  /** The arm that the value is for; empty where nothing says which. */
  readonly arm: string
  readonly value: unknown
  readonly onSet: (value: unknown) => void
}

export interface PoseRequest extends Request {
  readonly kind: 'pose'
  /** How its turn is written. */
  readonly form: 'xyzw' | 'rpy'
  /** The frames in which it may be given; only `world` where there is no choice. */
  readonly frames: readonly string[]
  /** What a frame that belongs to the state stands for: `part` for the part that it names. */
  readonly meant: (frame: string) => string
  /** A frame, whose z points up from the plane of its points; else what a tool is brought to. */
  readonly isFrame?: boolean
}

export interface PlainRequest extends Request {
  readonly kind: 'joints' | 'region' | 'grid'
}

export interface WaypointRequest extends Request {
  readonly kind: 'waypoints'
  /** The entries that may be waypoints. */
  readonly entries: readonly EntryName[]
}

export type WizardRequest = PoseRequest | PlainRequest | WaypointRequest

export const useWizard = pageStore<{ readonly asked: WizardRequest | undefined }>(() => ({ asked: undefined }))

export function askWizard(asked: WizardRequest | undefined): void {
  useWizard.setState({ asked })
}
