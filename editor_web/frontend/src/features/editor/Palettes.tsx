/** The palettes: what to add, and where an outcome leads. */
import { IconCircleDot, IconFlag } from '@tabler/icons-react'
import { useMemo } from 'react'
import { isMachine, nodeOf, outgoingTransitions, type EditNode } from '../../document/editing/model'
import { nameOfPath, parentPath } from '../../document/path'
import { add, connect, disconnect, focusNode } from './actions'
import { fits, itemsOf } from './additions'
import { openPortPalette } from './paletteRequests'
import { replaceType } from './typeReplacement'
import { ChoiceBox, type Choice } from '../../components/ChoiceBox'
import { KindIcon } from '../../components/KindIcon'
import { declaredOutcomes } from '../../document/editing/expansion'
import { draftOf, editor, rootOf, setEditor, useEditor, type PaletteRequest } from './store'

export function Palettes() {
  const palette = useEditor((s) => s.palette)
  if (!palette) return null
  const close = () => {
    setEditor({ palette: undefined })
    const last = editor().selection.at(-1)
    if (last) focusNode(last)
  }
  switch (palette.kind) {
    case 'add':
      return <AddPalette request={palette} onClose={close} />
    case 'connect':
      return <ConnectPalette path={palette.path} onClose={close} />
    case 'replace':
      return <ReplacePalette paths={palette.paths} onClose={close} />
  }
}

function AddPalette({ request, onClose }: { request: Extract<PaletteRequest, { kind: 'add' }>; onClose: () => void }) {
  const catalogue = useEditor((s) => s.catalogue)
  const id = useEditor((s) => s.id)
  const root = useEditor(rootOf)
  const outcomes = useEditor((s) => draftOf(s).document?.outcomes ?? NONE)
  const parent = nodeOf(root, request.parent)
  const choices = useMemo(() => {
    if (!catalogue || !root || !parent) return []
    const targets = request.from && !request.from.isInsert ? targetChoices(root, parent, outcomes, request.from) : []
    const items = itemsOf(catalogue, id).filter((item) => fits(item, parent))
    return [
      ...targets,
      ...items.map((item): Choice => ({
        id: item.id,
        title: item.title,
        group: item.group,
        detail: item.summary,
        icon: <KindIcon icon={item.icon} size={15} />,
        run: () => void add(item.addition, request),
      })),
    ]
  }, [catalogue, id, root, parent, outcomes, request])
  const from = request.from
  const what = from
    ? from.isInsert
      ? `Insert after ${nameOfPath(from.path)}: ${from.outcome}`
      : `${nameOfPath(from.path)}: ${from.outcome} leads to`
    : `Add to ${parent?.name ?? ''}`
  return (
    <ChoiceBox
      label={what}
      placeholder={`${what} …`}
      choices={choices}
      at={request.screen}
      onClose={onClose}
      fromText={from && !from.isInsert && parent && isMachine(parent.kind) ? (text) => newOutcome(text, from) : undefined}
    />
  )
}

const NONE: readonly string[] = []

interface From {
  readonly path: string
  readonly outcome: string
}

/** The nodes and outcomes that an outcome can lead to. */
function targetChoices(root: EditNode, parent: EditNode, outcomes: readonly string[], from: From): readonly Choice[] {
  if (!isMachine(parent.kind)) return []
  const inside = new Set(parent.children.map((child) => child.name))
  const ends = [...new Set([...declaredOutcomes(root, outcomes)(parent), ...parent.outcomes])].filter((outcome) => !inside.has(outcome))
  const present = outgoingTransitions(parent, nodeOf(root, from.path) ?? parent).find(
    (transition) => transition.outcome === from.outcome,
  )?.target
  return [
    ...parent.children.map((child): Choice => ({
      id: `to:${child.name}`,
      title: child.name,
      group: 'Nodes here',
      detail: child.title,
      icon: <KindIcon icon={child.icon} size={15} />,
      run: () => void connect(from.path, from.outcome, child.name),
    })),
    ...ends.map((outcome): Choice => ({
      id: `end:${outcome}`,
      title: outcome,
      group: parent === root ? 'Outcomes of the behavior' : `Outcomes of ${parent.name}`,
      icon: <IconFlag size={15} aria-hidden />,
      run: () => void connect(from.path, from.outcome, outcome),
    })),
    ...(present === undefined
      ? []
      : [
          {
            id: 'nowhere',
            title: 'Disconnect',
            group: 'Nowhere',
            detail: `now leads to ${present}`,
            run: () => void disconnect(from.path, from.outcome),
          },
        ]),
  ]
}

function newOutcome(text: string, from: From): Choice | undefined {
  if (!/^[A-Za-z0-9_][A-Za-z0-9_-]{0,63}$/.test(text)) return undefined
  return {
    id: 'new-outcome',
    title: text,
    group: 'A new outcome',
    detail: 'of the container',
    icon: <IconFlag size={15} aria-hidden />,
    run: () => void connect(from.path, from.outcome, text),
  }
}

function ConnectPalette({ path, onClose }: { path: string; onClose: () => void }) {
  const root = useEditor(rootOf)
  const node = nodeOf(root, path)
  const parent = nodeOf(root, parentPath(path))
  const transitions = node ? outgoingTransitions(parent, node).filter((transition) => transition.isOutcome) : []
  const choices = transitions.map((transition): Choice => ({
    id: transition.outcome,
    title: transition.outcome,
    group: 'Which outcome',
    detail: transition.target === undefined ? 'not connected' : `now leads to ${transition.target}`,
    icon: <IconCircleDot size={15} aria-hidden />,
    // In the same update: what is typed on goes to the next box.
    run: () => openPortPalette(path, transition.outcome),
  }))
  return <ChoiceBox label={`Connect ${node?.name ?? ''}`} placeholder="Which outcome …" choices={choices} onClose={onClose} />
}

function ReplacePalette({ paths, onClose }: { paths: readonly string[]; onClose: () => void }) {
  const catalogue = useEditor((s) => s.catalogue)
  const id = useEditor((s) => s.id)
  const root = useEditor(rootOf)
  const what = `Replace ${paths.length === 1 ? nameOfPath(paths[0] ?? '') : `${paths.length} nodes`} by`
  const choices = useMemo(() => {
    const nodes = paths.flatMap((path) => nodeOf(root, path) ?? [])
    const parents = paths.map((path) => nodeOf(root, parentPath(path)))
    const items = catalogue ? itemsOf(catalogue, id) : []
    return items
      .filter((item) => parents.every((parent) => (parent ? fits(item, parent) : !item.onlyInTree)))
      .filter(
        ({ addition }) =>
          !nodes.every((node) => node.kind === addition.kind && (addition.runs === undefined || node.title === addition.runs)),
      )
      .map((item): Choice => ({
        id: item.id,
        title: item.title,
        group: item.group,
        detail: item.summary,
        icon: <KindIcon icon={item.icon} size={15} />,
        run: () => void replaceType(paths, item.addition),
      }))
  }, [catalogue, id, root, paths])
  return <ChoiceBox label={what} placeholder={`${what} …`} choices={choices} onClose={onClose} />
}
