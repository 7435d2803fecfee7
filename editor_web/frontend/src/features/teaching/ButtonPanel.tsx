/** Keys and gamepad buttons of this computer as buttons of the Helping Hand. */
import { Badge, Flex, Group, Kbd, Stack, Switch, Text, TextInput, UnstyledButton } from '@mantine/core'
import { IconDeviceGamepad2, IconPlus, IconTrash } from '@tabler/icons-react'
import { useState } from 'react'
import { useDisabledReason, useTeach } from '../../api/teaching'
import { CommandButton } from '../../components/CommandButton'
import { buttonFault, keepKeys, useButtonMap, type KeyButton } from './buttonMap'
import { RowTool } from '../../components/RowTool'
import { Refusal } from '../../components/Refusal'

export function ButtonPanel() {
  const { isOn, keys, pressed } = useButtonMap()
  const off = useDisabledReason()
  const refusal = useTeach((s) => s.refused.button)
  const hand = useTeach((s) => s.hand)
  const listening = new Set((hand?.triggers ?? []).map((each) => each.trigger.trig_topic.replace(/^\/|\/$/g, '')))
  const pads = [...pressed].filter((each) => each.startsWith('gamepad/'))

  return (
    <Stack gap="xs">
      <Switch
        size="sm"
        label="Keys and gamepad of this computer are buttons"
        description="While this page is in front, and not while something is typed"
        checked={isOn}
        disabled={off !== undefined}
        onChange={(event) => useButtonMap.setState({ isOn: event.currentTarget.checked })}
      />
      <Flex component="ul" direction="column" gap={6} m={0} p={0} style={{ listStyle: 'none' }} aria-label="Keys">
        {keys.map((each, at) => (
          <KeyRow
            key={at}
            keyButton={each}
            isPressed={pressed.has(`keyboard/${each.button}`)}
            isHeard={listening.has(`buttons/keyboard/${each.button}`)}
            onChange={(next) => keepKeys(keys.map((other, index) => (index === at ? next : other)))}
            onRemove={() => keepKeys(keys.filter((_, index) => index !== at))}
          />
        ))}
      </Flex>
      <Group>
        <CommandButton
          label="Add a key"
          icon={<IconPlus size={15} aria-hidden />}
          onPress={() => keepKeys([...keys, { code: '', button: `button_${keys.length + 1}` }])}
        />
      </Group>
      <Group gap="xs" wrap="nowrap" role="status" aria-label="Gamepad">
        <IconDeviceGamepad2 size={18} style={{ flex: 'none' }} aria-hidden />
        {pads.length > 0 ? (
          pads.map((each) => (
            <Badge key={each} variant="light" tt="none">
              {each}
            </Badge>
          ))
        ) : (
          <Text span size="sm" c="dimmed">
            Press a button of a gamepad: it is published on buttons/gamepad/south, east, start…
          </Text>
        )}
      </Group>
      {refusal && <Refusal>{refusal.message}. Add a trigger for it.</Refusal>}
    </Stack>
  )
}

interface KeyRowProps {
  readonly keyButton: KeyButton
  readonly isPressed: boolean
  readonly isHeard: boolean
  readonly onChange: (next: KeyButton) => void
  readonly onRemove: () => void
}

function KeyRow({ keyButton, isPressed, isHeard, onChange, onRemove }: KeyRowProps) {
  const [isAsking, setAsking] = useState(false)
  return (
    <Flex component="li" wrap="wrap" align="center" gap="xs">
      <UnstyledButton
        w="7em"
        aria-label={`Key of ${keyButton.button}: ${keyButton.code || 'none'}`}
        title="Click, then press the key"
        onClick={() => setAsking(true)}
        onBlur={() => setAsking(false)}
        onKeyDown={(event) => {
          if (!isAsking || event.key === 'Tab') return
          event.preventDefault()
          event.stopPropagation()
          setAsking(false)
          if (event.key !== 'Escape') onChange({ ...keyButton, code: event.code })
        }}
      >
        <Kbd size="sm" display="block" ta="center" {...(isPressed && { bg: 'var(--active-soft)', c: 'var(--active)' })}>
          {isAsking ? 'press a key…' : keyButton.code || 'choose a key'}
        </Kbd>
      </UnstyledButton>
      <TextInput
        size="xs"
        flex="1 1 6em"
        aria-label={`Button of ${keyButton.code}`}
        value={keyButton.button}
        error={buttonFault(keyButton.button) !== ''}
        onChange={(event) => onChange({ ...keyButton, button: event.currentTarget.value })}
      />
      <Text span size="xs" c="dimmed" w="8em">
        {isPressed ? 'pressed' : isHeard ? 'a trigger listens' : 'nobody listens'}
      </Text>
      <RowTool label={`Remove ${keyButton.button}`} onPress={onRemove}>
        <IconTrash size={14} aria-hidden />
      </RowTool>
    </Flex>
  )
}
