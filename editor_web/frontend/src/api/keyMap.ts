/** The keys of commands: what somebody has changed of them is kept in this browser. */
import { chordForReaders, chordText, isCharacter, isChord, type Chord, type Press } from '../document/chord'
import {
  chordsOf,
  COMMAND_TABLE,
  readOwnKeys,
  withKeys,
  type CommandId,
  type CommandIdOf,
  type CommandPlace,
  type CommandRow,
  type OwnKeys,
} from '../document/commandTable'
import { pageStore } from './pageStore'

interface KeyMap {
  readonly own: OwnKeys
  /** Whether characters by themselves are commands; those who speak to their computer switch them off. */
  readonly areSingleOn: boolean
  /** Whether the list of keys is on the page. */
  readonly isShown: boolean
}

const KEPT = 'flexcell.keys'

export const useKeyMap = pageStore<KeyMap>(kept)

export function showKeys(isShown = true): void {
  useKeyMap.setState({ isShown })
}

/** Give a command these keys, which no other one has then; with undefined those that it has at first. */
export function setKeys(id: CommandId, chords: readonly Chord[] | undefined): void {
  keep({ own: withKeys(useKeyMap.getState().own, id, chords) })
}

export function resetKeys(): void {
  keep({ own: {} })
}

export function switchSingleKeys(areSingleOn: boolean): void {
  keep({ areSingleOn })
}

/** Take over what was changed in another window of this browser. */
export function takeKeptKeys(): void {
  const { own, areSingleOn } = kept()
  useKeyMap.setState({ own, areSingleOn })
}

/** The command of a page that a press means, if any. */
export function commandOf<Place extends CommandPlace>(press: Press, place: Place): CommandIdOf<Place> | undefined {
  const { own, areSingleOn } = useKeyMap.getState()
  if (!areSingleOn && isCharacter(press)) return undefined
  const rows: readonly CommandRow[] = COMMAND_TABLE
  const row = rows.find((each) => each.place === place && chordsOf(each.id, own).some((chord) => isChord(press, chord)))
  return row?.id as CommandIdOf<Place> | undefined
}

/** The first key of a command as it is written on keyboards, and for screen readers. */
export function useKeyOf(id: CommandId | undefined): { readonly text?: string; readonly forReaders?: string } {
  const own = useKeyMap((s) => s.own)
  const chord = id && chordsOf(id, own)[0]
  return chord ? { text: chordText(chord), forReaders: chordForReaders(chord) } : {}
}

/** The same, where no part of the page has to follow it. */
export function keyOf(id: CommandId): string | undefined {
  const chord = chordsOf(id, useKeyMap.getState().own)[0]
  return chord && chordText(chord)
}

function keep(change: Partial<KeyMap>): void {
  useKeyMap.setState(change)
  const { own, areSingleOn } = useKeyMap.getState()
  localStorage.setItem(KEPT, JSON.stringify({ own, areSingleOn }))
}

function kept(): KeyMap {
  const atFirst = { own: {}, areSingleOn: true, isShown: false }
  try {
    const found: unknown = JSON.parse(localStorage.getItem(KEPT) ?? 'null')
    if (typeof found !== 'object' || found === null) return atFirst
    const areSingleOn = !('areSingleOn' in found) || found.areSingleOn !== false
    return { ...atFirst, own: 'own' in found ? readOwnKeys(found.own) : {}, areSingleOn }
  } catch {
    // What somebody else has written there is no reason not to start.
    return atFirst
  }
}
