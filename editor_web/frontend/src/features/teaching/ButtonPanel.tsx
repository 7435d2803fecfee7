/** Keys and gamepad buttons of this computer as buttons of the Helping Hand. */
import { Switch, TextInput } from '@mantine/core'
import { IconDeviceGamepad2, IconPlus, IconTrash } from '@tabler/icons-react'
import { useState } from 'react'
import { useDisabledReason, useTeach } from '../../api/teaching'
import { CommandButton } from '../../components/CommandButton'
import { buttonFault, keepKeys, useButtonMap, type KeyButton } from './buttonMap'

export function ButtonPanel() {
  const { isOn, keys, pressed } = useButtonMap()
  const off = useDisabledReason()
  const refusal = useTeach((s) => s.refused.button)
  const hand = useTeach((s) => s.hand)
  const listening = new Set((hand?.triggers ?? []).map((each) => each.trigger.trig_topic.replace(/^\/|\/$/g, '')))
  const pads = [...pressed].filter((each) => each.startsWith('gamepad/'))

  return (
    <div className="buttons">
      <Switch
        size="sm"
        label="Keys and gamepad of this computer are buttons"
        description="While this page is in front, and not while something is typed"
        checked={isOn}
        disabled={off !== undefined}
        onChange={(event) => useButtonMap.setState({ isOn: event.currentTarget.checked })}
      />
      <ul className="plain-list key-list" aria-label="Keys">
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
      </ul>
      <CommandButton
        label="Add a key"
        icon={<IconPlus size={15} aria-hidden />}
        onPress={() => keepKeys([...keys, { code: '', button: `button_${keys.length + 1}` }])}
      />
      <p className="pad-row" role="status" aria-label="Gamepad">
        <IconDeviceGamepad2 size={18} aria-hidden />
        {pads.length > 0 ? (
          pads.map((each) => (
            <span key={each} className="tag is-on">
              {each}
            </span>
          ))
        ) : (
          <span className="quiet">Press a button of a gamepad: it is published on buttons/gamepad/south, east, start…</span>
        )}
      </p>
      {refusal && (
        <p className="teach-problem" role="alert">
          {refusal.message}. Add a trigger for it.
        </p>
      )}
    </div>
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
    <li className={`key-row${isPressed ? ' is-pressed' : ''}`}>
      <button
        type="button"
        className="key-cap"
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
        {isAsking ? 'press a key…' : keyButton.code || 'choose a key'}
      </button>
      <TextInput
        size="xs"
        aria-label={`Button of ${keyButton.code}`}
        value={keyButton.button}
        error={buttonFault(keyButton.button) !== ''}
        onChange={(event) => onChange({ ...keyButton, button: event.currentTarget.value })}
      />
      <span className="quiet key-heard">{isPressed ? 'pressed' : isHeard ? 'a trigger listens' : 'nobody listens'}</span>
      <CommandButton
        label={`Remove ${keyButton.button}`}
        isCompact
        tone="quiet"
        icon={<IconTrash size={14} aria-hidden />}
        onPress={onRemove}
      />
    </li>
  )
}
