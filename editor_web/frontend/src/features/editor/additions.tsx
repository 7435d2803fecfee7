/** Everything that can be put into a container, for the library and the palette: one list. */
import type { CatalogueBody, EntryName, StateView } from '../../api/types'
import { isTreePart, nameFor, type EditNode } from '../../document/editing/model'
import { fileTitle, relativePath } from '../../document/path'
import type { Addition } from './actions'

export interface Item {
  readonly id: string
  readonly title: string
  readonly group: string
  /** One line of what it is for. */
  readonly summary: string
  /** All that its author wrote about it. */
  readonly doc: string
  readonly outcomes: readonly string[]
  readonly kind: string
  /** The name of the icon of the node that it is; empty for an entry. */
  readonly icon: string
  readonly onlyInTree: boolean
  readonly addition: Addition
  /** The named entry that it goes to. */
  readonly entry?: EntryName
}

/** States first, then containers, then other behaviors. */
export function itemsOf(catalogue: CatalogueBody, id: string): readonly Item[] {
  const states = catalogue.states.map((state) => stateItem(state))
  const containers = catalogue.containers.map((each): Item => ({
    id: `kind:${each.kind}`,
    title: each.title,
    group: each.only_in_tree ? 'Parts of trees' : 'Containers',
    summary: firstLine(each.doc),
    doc: each.doc,
    outcomes: [],
    kind: each.kind,
    icon: each.icon,
    onlyInTree: each.only_in_tree,
    addition: { kind: each.kind, name: each.kind },
  }))
  const behaviors = catalogue.behaviors
    .filter((each) => each.id !== id)
    .map((each): Item => ({
      id: `behavior:${each.id}`,
      title: each.name,
      group: 'Behaviors',
      summary: each.description,
      doc: each.description,
      outcomes: each.outcomes,
      kind: 'behavior',
      icon: each.icon,
      onlyInTree: false,
      addition: {
        kind: 'behavior',
        runs: relativePath(id, each.id),
        name: nameFor(fileTitle(each.id)),
      },
    }))
  return [...states, ...containers, ...behaviors]
}

function stateItem(state: StateView): Item {
  return {
    id: `state:${state.name}`,
    title: state.name,
    group: state.group,
    summary: firstLine(state.doc),
    doc: state.doc,
    outcomes: state.outcomes,
    kind: 'state',
    icon: state.icon,
    onlyInTree: false,
    addition: { kind: 'state', runs: state.name, name: nameFor(state.name) },
  }
}

function firstLine(text: string): string {
  return text.split('\n')[0] ?? ''
}

/** Can it stand in this container? */
export function fits(item: Item, parent: EditNode): boolean {
  return !item.onlyInTree || isTreePart(parent.kind)
}

/** The state that goes to a named entry, with the entry as its target. */
export function entryAddition(entry: EntryName, catalogue: CatalogueBody): Addition | undefined {
  const stateNames: Record<string, string> = {
    joints: 'motion.MoveJoints',
    pose: 'motion.MoveLinear',
    dmp: 'motion.FollowJointDmp',
    cart_dmp: 'motion.FollowCartDmp',
  }
  const state = catalogue.states.find((each) => each.name === stateNames[entry.kind])
  if (!state) return undefined
  const parameter = state.parameters.find(
    (key) => JSON.stringify(key.schema).includes(`"entry":"${entry.kind}"`) || JSON.stringify(key.schema).includes('"entry":'),
  )
  if (!parameter) return undefined
  const isObject = JSON.stringify(parameter.schema).includes('"properties"')
  return {
    kind: 'state',
    runs: state.name,
    name: entry.name,
    parameters: { [parameter.name]: isObject ? { entry: entry.name } : entry.name },
  }
}
