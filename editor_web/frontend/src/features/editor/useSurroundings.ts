/** What the fields of a node choose from: names and entries of the cell, how it is now, and what the behavior adds to it. */
import { useMemo, useState } from 'react'
import { cellItemsQuery } from '../../api/cellItems'
import { useData } from '../../api/data'
import { useLive } from '../../api/live'
import { useAnswer } from '../../api/queryClient'
import type { CatalogueBody, CellStateFrame, EntryName } from '../../api/types'
import { lookup, type Dict } from '../../document/dict'
import { allNodes, type EditNode } from '../../document/editing/model'
import type { Surroundings } from '../../document/editing/offers'
import { armOf } from '../../document/editing/preview'
import { draftOf, rootOf, useEditor } from './store'

const NO_ENTRIES: readonly EntryName[] = []
const NO_NAMES: Dict<readonly string[]> = {}
const NO_PARAMETERS: Dict<Dict<unknown>> = {}
const NO_OUTPUTS: readonly boolean[] = []
// What such a parameter names is there afterwards.
const ADDS = ['new_cell_name', 'new_entry', 'new_entry_of']

/** How the cell is now is asked for while `isFocused`: somebody has a field in hand. */
export function useSurroundings(node: EditNode, isFocused: boolean): Surroundings {
  const catalogue = useEditor((s) => s.catalogue)
  const own = useEditor((s) => s.names)
  const root = useEditor(rootOf)
  const parameters = useEditor<Dict<Dict<unknown>> | undefined>((s) => draftOf(s).document?.parameters)
  const names = own ?? catalogue?.names ?? NO_NAMES
  const isOpenCell = own === undefined || isSame(own, catalogue?.names ?? NO_NAMES)
  const open = useOpenCell(armOf(node.parameters, parameters ?? NO_PARAMETERS, lookup(names, 'robot')), isFocused && isOpenCell)
  const added = useMemo(() => (root && catalogue ? addedNames(root, catalogue) : []), [root, catalogue])
  return {
    names,
    entries: catalogue?.entries ?? NO_ENTRIES,
    given: node.parameters,
    parameters: parameters ?? NO_PARAMETERS,
    added,
    isOpenCell,
    open,
  }
}

function useOpenCell(arm: string, isAsked: boolean): Surroundings['open'] {
  const robots = useLive((s) => s.robots)
  const { value: cell } = useAnswer({ ...cellItemsQuery(), enabled: isAsked })
  const [state, setState] = useState<CellStateFrame>()
  const [outputs, setOutputs] = useState<{ readonly of: string; readonly values: readonly boolean[] }>()
  const topic = arm ? `${arm}/digital_outputs` : ''
  useData(isAsked ? { number: 0, traffic: false, topic, fields: [], run: '', goals: '', cell: true } : undefined, (frame) => {
    if (frame.k === 'cell') setState(frame)
    if (frame.k === 'message' && frame.topic === topic) setOutputs({ of: topic, values: valuesOf(frame.value) })
  })
  if (!isAsked || !cell) return undefined
  return { items: cell.items, now: { robots, state }, outputs: outputs?.of === topic ? outputs.values : NO_OUTPUTS }
}

function valuesOf(message: unknown): readonly boolean[] {
  const values = (message as { readonly values?: unknown } | null)?.values
  return Array.isArray(values) ? values.map((each) => each === true) : NO_OUTPUTS
}

/** Is the cell that the document names the one that is open? */
function isSame(own: CatalogueBody['names'], open: CatalogueBody['names']): boolean {
  return ['robot', 'part', 'camera', 'link'].every((kind) => (lookup(own, kind) ?? []).join() === (lookup(open, kind) ?? []).join())
}

function addedNames(root: EditNode, catalogue: CatalogueBody): readonly string[] {
  const adding = new Map(
    catalogue.states.map((state) => [
      state.name,
      state.parameters.filter((key) => ADDS.some((word) => word in key.schema)).map((key) => key.name),
    ]),
  )
  return allNodes(root).flatMap((node) => {
    const keys = (node.state ? adding.get(node.state) : undefined) ?? []
    return keys.map((key) => lookup(node.parameters, key)).filter((value) => typeof value === 'string')
  })
}
