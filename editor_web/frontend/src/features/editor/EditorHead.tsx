/** The head of the editor: which behavior, whether it is saved, and what can be done with all of it. */
import { showKeys } from '../../api/keyMap'
import { openSearch } from '../../api/search'
import { Badge, Box, Button, Flex, Group, Text, Title } from '@mantine/core'
import {
  IconArrowBackUp,
  IconArrowForwardUp,
  IconCode,
  IconCommand,
  IconDeviceFloppy,
  IconKeyboard,
  IconPlayerPlayFilled,
} from '@tabler/icons-react'
import { CommandButton } from '../../components/CommandButton'
import { StatusIcon } from '../../components/StatusIcon'
import { isError, problemsOf, unfinishedWords } from '../../document/editing/findings'
import { canRedo, canUndo } from '../../document/editing/history'
import { nameOfPath } from '../../document/path'
import { redo, undo } from './apply'
import { EditHistory } from './EditHistory'
import { FileMenu } from './FileMenu'
import classes from './frame.module.css'
import { save } from './session'
import { draftOf, isDirty, setEditor, useEditor } from './store'

export function EditorHead({ mayEdit, onRun }: { mayEdit: boolean; onRun: () => void }) {
  const id = useEditor((s) => s.id)
  const name = useEditor((s) => draftOf(s).document?.name || nameOfPath(s.id))
  const dirty = useEditor(isDirty)
  const back = useEditor((s) => (canUndo(s.history) ? s.history.steps[s.history.at]?.label : undefined))
  const forth = useEditor((s) => (canRedo(s.history) ? s.history.steps[s.history.at + 1]?.label : undefined))
  const isTextShown = useEditor((s) => s.isTextShown)
  const noSave = mayEdit ? undefined : 'you may look only'
  return (
    <Flex
      component="header"
      flex="none"
      align="center"
      gap="sm"
      px="md"
      py="0.45rem"
      bg="var(--surface)"
      wrap={{ base: 'wrap', md: 'nowrap' }}
      style={{ borderBottom: '1px solid var(--line)' }}
      data-editor-head
    >
      <Box miw={0}>
        <Group gap="xs" wrap="nowrap">
          <Title order={1} fz="lg" fw={650} lh={1.25}>
            {name}
          </Title>
          {dirty && (
            <Badge variant="light" color="orange" c="var(--stopped)" bg="var(--stopped-soft)" tt="none" role="status" data-unsaved>
              not saved
            </Badge>
          )}
        </Group>
        <Text size="xs" c="dimmed" ff="monospace" truncate>
          {id}
        </Text>
      </Box>
      <div className={classes['commands']}>
        <CommandButton
          isCompact
          label="Undo"
          command="undo"
          hint={back && `Undo: ${back}`}
          obstacle={back === undefined ? 'nothing was changed' : undefined}
          icon={<IconArrowBackUp size={16} aria-hidden />}
          onPress={undo}
          tone="quiet"
        />
        <CommandButton
          isCompact
          label="Redo"
          command="redo"
          hint={forth && `Redo: ${forth}`}
          obstacle={forth === undefined ? 'nothing was undone' : undefined}
          icon={<IconArrowForwardUp size={16} aria-hidden />}
          onPress={redo}
          tone="quiet"
        />
        <EditHistory />
        <ProblemCount />
        <CommandButton
          isCompact
          label="Text"
          command="text"
          hint="The document as text, beside the canvas"
          isPressed={isTextShown}
          icon={<IconCode size={16} aria-hidden />}
          onPress={() => setEditor({ isTextShown: !isTextShown })}
        />
        <CommandButton
          isCompact
          label="Commands"
          command="search"
          hint="Every command, and every node to go to"
          icon={<IconCommand size={16} aria-hidden />}
          onPress={openSearch}
        />
        <CommandButton
          isCompact
          label="Keys"
          command="sheet"
          icon={<IconKeyboard size={16} aria-hidden />}
          onPress={() => showKeys()}
          tone="quiet"
        />
        <FileMenu mayEdit={mayEdit} />
        <CommandButton
          label="Save"
          command="save"
          obstacle={noSave}
          icon={<IconDeviceFloppy size={16} aria-hidden />}
          onPress={() => void save()}
          tone={dirty ? 'strong' : 'plain'}
        />
        <CommandButton
          label="Run"
          command="run"
          hint="Saves, checks, and opens the run page"
          obstacle={noSave}
          icon={<IconPlayerPlayFilled size={14} aria-hidden />}
          onPress={onRun}
          tone="strong"
        />
      </div>
    </Flex>
  )
}

const LOOKS = { failed: 'var(--failed)', warning: 'var(--stopped)', idle: 'dimmed', done: 'dimmed' }

function ProblemCount() {
  const errors = useEditor((s) => problemsOf(draftOf(s)).filter(isError).length)
  const isUnfinished = useEditor((s) => unfinishedWords(draftOf(s).root) !== '')
  const warnings = useEditor((s) => problemsOf(draftOf(s)).length) - errors
  const words =
    errors + warnings === 0
      ? isUnfinished
        ? 'Not finished'
        : 'No problems'
      : [errors > 0 && count(errors, 'error'), warnings > 0 && count(warnings, 'warning')].filter(Boolean).join(', ')
  const status = errors > 0 ? 'failed' : warnings > 0 ? 'warning' : isUnfinished ? 'idle' : 'done'
  return (
    <Button
      size="compact-sm"
      h={30}
      fw={550}
      variant={errors + warnings === 0 ? 'subtle' : 'default'}
      c={LOOKS[status]}
      {...(status === 'failed' ? { bd: '1px solid var(--failed)' } : {})}
      leftSection={<StatusIcon status={status} size={15} />}
      data-problem-count
      onClick={() => setEditor({ tab: 'problems' })}
    >
      <span aria-live="polite">{words}</span>
    </Button>
  )
}

function count(number: number, word: string): string {
  return `${number} ${word}${number === 1 ? '' : 's'}`
}
