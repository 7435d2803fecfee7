/** The head of the editor of the cell: which document, undo and redo with their history, saving, and what the open cell shows. */
import { Alert, Badge, Button, Group, Menu, NativeSelect, Text } from '@mantine/core'
import { IconArrowBackUp, IconArrowForwardUp, IconDeviceFloppy, IconHistory, IconPlugConnected } from '@tabler/icons-react'
import { useState } from 'react'
import type { CellDocumentName, SessionBody } from '../../api/types'
import { wordsOf } from '../../api/client'
import { switchSimulation } from '../../api/realDevices'
import { CommandButton } from '../../components/CommandButton'
import { Refusal } from '../../components/Refusal'
import { canRedo, canUndo } from '../../document/editing/history'
import { ConflictNote } from './ConflictNote'
import { closeCellDocument, jumpTo, openCellDocument, redo, save, undo } from './session'
import { draftOf, isDirty, setCellEditor, useCellEditor } from './store'
import { useCellKeys } from './useCellKeys'
import { useRestFindings } from './useRestFindings'

const SHOWN_STEPS = 100

interface EditorBarProps {
  readonly documents: readonly CellDocumentName[]
  readonly session: SessionBody | undefined
  /** The open cell is of another text than the file has. */
  readonly isChanged: boolean
  readonly onSaved: () => void
}

export function EditorBar({ documents, session, isChanged, onSaved }: EditorBarProps) {
  const id = useCellEditor((s) => s.id)
  const dirty = useCellEditor(isDirty)
  const steps = useCellEditor((s) => s.history.steps)
  const at = useCellEditor((s) => s.history.at)
  const notice = useCellEditor((s) => s.notice)
  const problem = useCellEditor((s) => s.problem)
  const faults = useCellEditor((s) => draftOf(s).findings)
  const elsewhere = faults.filter((each) => !each.path)
  const unsaved = dirty ? 'save or undo the changes first' : undefined

  async function write(): Promise<void> {
    if (await save()) onSaved()
  }

  useCellKeys(() => void write())
  useRestFindings()

  return (
    <>
      <Group gap="xs" px="md" py={6} bg="var(--surface)" role="toolbar" aria-label="Edit the cell">
        <NativeSelect
          size="xs"
          aria-label="Document"
          value={id}
          disabled={dirty}
          title={unsaved ?? ''}
          data={documents.map((each) => each.id)}
          onChange={(event) => void openCellDocument(event.currentTarget.value)}
        />
        {dirty && (
          <Badge variant="light" color="orange" c="var(--stopped)" bg="var(--stopped-soft)" tt="none" role="status" data-unsaved>
            not saved
          </Badge>
        )}
        <CommandButton
          label="Undo"
          icon={<IconArrowBackUp size={15} aria-hidden />}
          obstacle={canUndo({ at }) ? undefined : 'nothing was changed'}
          hint={steps[at]?.label}
          onPress={undo}
        />
        <CommandButton
          label="Redo"
          icon={<IconArrowForwardUp size={15} aria-hidden />}
          obstacle={canRedo({ at, steps }) ? undefined : 'nothing was undone'}
          hint={steps[at + 1]?.label}
          onPress={redo}
        />
        <Menu position="bottom-start" shadow="md">
          <Menu.Target>
            <Button size="xs" px="xs" variant="default" disabled={steps.length < 2} leftSection={<IconHistory size={15} aria-hidden />}>
              History
            </Button>
          </Menu.Target>
          <Menu.Dropdown aria-label="History of edits" mah="60vh" style={{ overflow: 'auto' }}>
            {steps
              .map(({ label }, index) => ({ label, index }))
              .slice(-SHOWN_STEPS)
              .toReversed()
              .map(({ label, index }) => (
                <Menu.Item
                  key={index}
                  aria-current={index === at ? 'step' : undefined}
                  {...(index > at ? { c: 'dimmed' } : {})}
                  onClick={() => jumpTo(index)}
                >
                  {label}
                </Menu.Item>
              ))}
          </Menu.Dropdown>
        </Menu>
        <CommandButton
          label="Save"
          tone="strong"
          icon={<IconDeviceFloppy size={15} aria-hidden />}
          obstacle={dirty ? undefined : 'everything is saved'}
          onPress={() => void write()}
        />
        <CommandButton label="Close the editor" obstacle={unsaved} onPress={closeCellDocument} />
        <Text size="xs" c="dimmed" ml="auto">
          Nothing moves by what you edit or save here.
        </Text>
      </Group>
      <Refusal isWide title="The document cannot be edited:">
        {problem}
      </Refusal>
      {(dirty || isChanged) && <OpenedBefore session={session} obstacle={dirty ? 'save the changes first' : undefined} />}
      {notice && (
        <Refusal isWide title={`${notice.what}:`} hint={notice.hint} onClose={() => setCellEditor({ notice: undefined })}>
          {notice.message}
        </Refusal>
      )}
      {elsewhere.map((each) => (
        <Refusal key={`${each.line} ${each.message}`} isWide title={each.line > 0 ? `Line ${each.line}:` : ''} hint={each.hint}>
          {each.message}
        </Refusal>
      ))}
      <ConflictNote onSaved={onSaved} />
    </>
  )
}

/** The open cell is as its document was when it was opened; here it is opened anew. */
function OpenedBefore({ session, obstacle }: { readonly session: SessionBody | undefined; readonly obstacle: string | undefined }) {
  const [problem, setProblem] = useState<string>()
  const [isBusy, setBusy] = useState(false)

  function reopen(): void {
    setBusy(true)
    setProblem(undefined)
    const simulated = (session?.devices ?? []).filter((each) => each.simulated).map((each) => each.device)
    switchSimulation(simulated)
      .catch((error: unknown) => setProblem(wordsOf(error)))
      .finally(() => setBusy(false))
  }

  return (
    <Alert color="yellow" p="xs" radius={0} role="status">
      <Group gap="xs">
        <Text size="sm">The open cell and the 3D view are as the document was when the cell was opened.</Text>
        {isBusy ? (
          <Text size="sm">The cell is opened anew…</Text>
        ) : (
          <CommandButton
            label="Connect the cell anew"
            icon={<IconPlugConnected size={14} aria-hidden />}
            hint="Closes the cell and opens it with the saved document; simulated parts are back at their initial poses"
            obstacle={obstacle}
            onPress={reopen}
          />
        )}
      </Group>
      <Refusal title="The cell was not opened anew:">{problem}</Refusal>
    </Alert>
  )
}
