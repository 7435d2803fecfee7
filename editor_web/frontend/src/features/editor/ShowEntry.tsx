/** Shows a named entry in 3D: from the field that holds it, and from the library. */
import { ActionIcon, Box } from '@mantine/core'
import { IconCube } from '@tabler/icons-react'
import { createContext, useContext, useEffect } from 'react'
import { showPreview, usePreview } from '../../api/preview'
import type { EntryName } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import type { EditField } from '../../document/editing/fields'
import type { EditNode } from '../../document/editing/model'
import { armOf, byDefault, entryNamed, PLACED } from '../../document/editing/preview'
import rows from './row.module.css'
import { draftOf, showEditorRefusal, useEditor } from './store'

/** Has the server a 3D view? */
export const CellViewContext = createContext(false)

const NO_VIEW = 'this server has no 3D view'
const NO_PARAMETERS = {}

interface FieldPreviewProps {
  readonly node: EditNode
  readonly field: EditField
  readonly value: unknown
  readonly entries: readonly EntryName[]
  /** The choice of the opened list that is pointed at: it is shown before it is taken. */
  readonly pointed: string | undefined
}

/** What is shown follows the field for as long as it was asked for here. */
export function FieldPreview({ node, field, value, entries, pointed }: FieldPreviewProps) {
  const hasView = useContext(CellViewContext)
  const parameters = useEditor((s) => draftOf(s).document?.parameters ?? NO_PARAMETERS)
  const by = `${node.path} ${field.name}`
  const isShown = usePreview((s) => s.shown?.by === by)
  const given = entryNamed(value)
  const name = pointed ?? (given && byDefault(given, parameters))
  const found = entries.find((entry) => entry.name === name && (field.entryKind ? entry.kind === field.entryKind : entry.kind in PLACED))
  const kind = field.entryKind || (found?.kind ?? '')
  const arm = armOf(node.parameters, parameters)
  useEffect(() => {
    if (isShown) showPreview({ by, kind, name: name ?? '', arm })
  }, [isShown, by, kind, name, arm])
  if (field.entryKind && !(field.entryKind in PLACED)) return null
  const why = isShown ? undefined : obstacle()
  return (
    <Box mt={4}>
      <CommandButton
        label={`Show ${field.name} in 3D`}
        hint={`Show where ${arm || 'the arm'} would be`}
        tone="quiet"
        icon={<IconCube size={15} aria-hidden />}
        isPressed={isShown}
        obstacle={why}
        // Where nothing hovers, the reason is told when it is pressed.
        onObstacle={() => why && showEditorRefusal('Show in 3D', why)}
        onPress={() => showPreview(isShown ? undefined : { by, kind, name: name ?? '', arm })}
      />
    </Box>
  )

  function obstacle(): string | undefined {
    if (!hasView) return NO_VIEW
    if (value === undefined || value === null || given === '') return 'choose an entry first'
    if (given === undefined) return 'the value is written out, it is no named entry'
    if (name === undefined) return 'which entry it is, only the run knows'
    return found ? undefined : `there is no ${[field.entryKind, 'entry', name].filter(Boolean).join(' ')}`
  }
}

/** Of an entry in the library no state says which arm goes there. */
export function LibraryPreview({ entry }: { readonly entry: EntryName }) {
  const hasView = useContext(CellViewContext)
  const by = `library ${entry.kind} ${entry.name}`
  const isShown = usePreview((s) => s.shown?.by === by)
  return (
    <ActionIcon
      variant={isShown ? 'light' : 'subtle'}
      color={isShown ? 'accent' : 'gray'}
      size={28}
      className={rows['aside']}
      aria-pressed={isShown}
      aria-disabled={!hasView || undefined}
      aria-label={`Show ${entry.name} (${entry.kind}) in 3D`}
      title={hasView ? 'Show in 3D' : `Not possible: ${NO_VIEW}`}
      onClick={() => hasView && showPreview(isShown ? undefined : { by, kind: entry.kind, name: entry.name, arm: '' })}
    >
      <IconCube size={15} aria-hidden />
    </ActionIcon>
  )
}
