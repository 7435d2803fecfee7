/** Every command with its keys: changed by pressing others, each by itself or all set back. */
import { ActionIcon, Box, Button, CloseButton, Flex, Group, Kbd, SimpleGrid, Switch, Text, TextInput, Title } from '@mantine/core'
import { IconKeyboard, IconRestore } from '@tabler/icons-react'
import { useState } from 'react'
import { resetKeys, setKeys, showKeys, switchSingleKeys, useKeyMap } from '../../api/keyMap'
import { Dialog } from '../../components/Dialog'
import { TourButton } from '../../components/TourButton'
import { chordText } from '../../document/chord'
import { chordsOf, COMMAND_TABLE, type CommandRow } from '../../document/commandTable'
import { found } from '../../document/editing/search'
import { KeyField } from './KeyField'

export function KeySheet() {
  const { own, areSingleOn, isShown } = useKeyMap()
  const [text, setText] = useState('')
  const [changed, change] = useState<string>()
  const close = () => showKeys(false)
  const rows: readonly CommandRow[] = COMMAND_TABLE
  const shown = found(rows, text, (row) => [row.words, row.part, ...chordsOf(row.id, own).map(chordText)])
  const parts = [...new Set(COMMAND_TABLE.map((row) => row.part))].filter((part) => shown.some((row) => row.part === part))
  return (
    <Dialog isWide isOpen={isShown} onClose={close} title="Keyboard">
      <Group gap="sm" mb="xs">
        <TextInput
          size="xs"
          flex={1}
          aria-label="Find a command or a key"
          placeholder="Find"
          value={text}
          rightSection={text && <CloseButton size="xs" aria-label="Clear" onClick={() => setText('')} />}
          onChange={(event) => setText(event.currentTarget.value)}
        />
        <Switch
          size="xs"
          label="Single keys are commands"
          checked={areSingleOn}
          onChange={(event) => switchSingleKeys(event.currentTarget.checked)}
        />
        <Button size="compact-xs" variant="default" disabled={Object.keys(own).length === 0} onClick={resetKeys}>
          Reset all
        </Button>
      </Group>
      <SimpleGrid minColWidth="21rem" spacing="lg" verticalSpacing="xs" fz="sm" mah="58vh" style={{ overflowY: 'auto' }}>
        {parts.map((part) => (
          <section key={part} aria-label={part}>
            <Title order={3} fz="sm" my={6}>
              {part}
            </Title>
            <Flex component="dl" direction="column" gap={2} m={0}>
              {shown
                .filter((row) => row.part === part)
                .map((row) => (
                  <KeyRow key={row.id} row={row} isChanged={changed === row.id} onChange={change} />
                ))}
            </Flex>
          </section>
        ))}
      </SimpleGrid>
      {parts.length === 0 && <Text size="sm">No command has these words.</Text>}
      <Text size="sm" c="dimmed" my="sm">
        Changed keys are kept in this browser. In the outline and on the canvas arrow keys go from node to node, Tab through all of them.
        Keys do nothing while you write in a field; out of the text leads Esc, then Tab. Ctrl+Shift+Backspace stops the cell and cannot be
        changed.
      </Text>
      <TourButton onOpened={close} />
    </Dialog>
  )
}

interface KeyRowProps {
  readonly row: CommandRow
  /** Whether its keys are being changed. */
  readonly isChanged: boolean
  readonly onChange: (id: string | undefined) => void
}

function KeyRow({ row, isChanged, onChange }: KeyRowProps) {
  const own = useKeyMap((s) => s.own)
  const chords = chordsOf(row.id, own)
  return (
    <Flex align="start" gap="xs" mih={26} data-key-of={row.id}>
      <Flex component="dt" wrap="wrap" gap={3} w="8.2rem" flex="none" pt={2}>
        {chords.map((chord) => (
          <Kbd key={chordText(chord)} size="xs">
            {chordText(chord)}
          </Kbd>
        ))}
        {chords.length === 0 && (
          <Text span size="xs" c="dimmed">
            none
          </Text>
        )}
      </Flex>
      <Box component="dd" m={0} flex={1}>
        <Flex align="center" gap="xs">
          <Text span inherit flex={1} {...(own[row.id] && { fw: 600 })}>
            {row.words}
          </Text>
          {own[row.id] && (
            <ActionIcon
              variant="subtle"
              color="gray"
              size={24}
              aria-label={`Reset: ${row.words}`}
              title="Reset"
              onClick={() => setKeys(row.id, undefined)}
            >
              <IconRestore size={15} aria-hidden />
            </ActionIcon>
          )}
          <ActionIcon
            variant="subtle"
            color="gray"
            size={24}
            aria-expanded={isChanged}
            aria-label={`Change the key: ${row.words}`}
            title="Change the key"
            onClick={() => onChange(isChanged ? undefined : row.id)}
          >
            <IconKeyboard size={15} aria-hidden />
          </ActionIcon>
        </Flex>
        {isChanged && <KeyField row={row} onDone={() => onChange(undefined)} />}
      </Box>
    </Flex>
  )
}
