/** Plays back something taught, slowly: it is shown first, a person says yes, and Escape stops it. */
import { Alert, Group, NativeSelect, Stack, Text } from '@mantine/core'
import { IconPlayerPlay, IconPlayerStopFilled } from '@tabler/icons-react'
import { useCallback, useEffect, useRef, useState } from 'react'
import { wordsOf } from '../../api/client'
import { endPreview, teach, useDisabledReason, type TaughtReference } from '../../api/teaching'
import { CommandButton } from '../../components/CommandButton'

const SPEEDS = [5, 10, 25, 50]

interface PlayBackProps {
  readonly arm: string
  readonly what: TaughtReference
  readonly words: string
  /** Show in the cell where the arm will go. */
  readonly onLook: () => void
}

export function PlayBack({ arm, what, words, onLook }: PlayBackProps) {
  const [stage, setStage] = useState<'idle' | 'asks' | 'moves'>('idle')
  const [percent, setPercent] = useState(10)
  const [message, setMessage] = useState('')
  const under = useRef<AbortController>(undefined)
  const off = useDisabledReason()

  const stop = useCallback(() => under.current?.abort(), [])

  function move(): void {
    const control = new AbortController()
    under.current = control
    setStage('moves')
    setMessage(`${arm} goes along ${words}`)
    teach
      .play({ arm, speed: percent / 100, revision: 0, ...what }, control.signal)
      .then(
        (played) => setMessage(played.status === 'succeeded' ? `${arm} has gone along ${words}` : played.cause),
        (error: unknown) => setMessage(control.signal.aborted ? 'Stopped' : wordsOf(error)),
      )
      .finally(() => {
        setStage('idle')
        endPreview()
      })
  }

  useEffect(() => {
    const onKey = (event: KeyboardEvent) => event.key === 'Escape' && stop()
    addEventListener('keydown', onKey)
    return () => {
      removeEventListener('keydown', onKey)
      stop()
    }
  }, [stop])

  return (
    <Stack gap="xs" align="flex-start">
      {stage === 'idle' && (
        <CommandButton
          label="Play back slowly"
          icon={<IconPlayerPlay size={15} aria-hidden />}
          obstacle={off}
          onPress={() => {
            onLook()
            setMessage('')
            setStage('asks')
          }}
        />
      )}
      {stage === 'asks' && (
        <Alert color="yellow" bg="var(--stopped-soft)" p="xs" role="group" aria-label="Play back">
          <Text size="sm" mb="xs">
            <strong>{arm} will move</strong> to the beginning of {words} and along it, whatever stands there. Look at the blue ghost first,
            and keep people out of reach.
          </Text>
          <Group gap={6}>
            <NativeSelect
              size="xs"
              aria-label="Speed of the play-back"
              value={String(percent)}
              onChange={(event) => setPercent(Number(event.currentTarget.value))}
              data={SPEEDS.map((each) => ({ value: String(each), label: `${each} % of its speed` }))}
            />
            <CommandButton label="Move the arm" tone="strong" obstacle={off} onPress={move} />
            <CommandButton label="Cancel" tone="quiet" onPress={() => setStage('idle')} />
          </Group>
        </Alert>
      )}
      {stage === 'moves' && (
        <CommandButton label="Stop (Escape)" tone="danger" icon={<IconPlayerStopFilled size={14} aria-hidden />} onPress={stop} />
      )}
      <Text span size="sm" c="dimmed" role="status" aria-label="Play-back">
        {message}
      </Text>
    </Stack>
  )
}
