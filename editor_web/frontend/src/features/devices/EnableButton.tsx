/** Asks for the reason before a real device may move, and says what enabling does at it. */
import { Button, Modal, Stack, Text, TextInput } from '@mantine/core'
import { IconLockOpen } from '@tabler/icons-react'
import { useState } from 'react'
import { DialogFooter } from '../../components/DialogFooter'
import { wordsOf } from '../../api/client'
import { useLive } from '../../api/liveStore'
import { enableDevice } from '../../api/realDevices'
import type { DeviceState } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { enableObstacle } from '../../document/devices'

interface EnableButtonProps {
  /** Of the device on the bus. */
  readonly address: string
  readonly state: Pick<DeviceState, 'connected'> | undefined
  /** What enabling does at this device. */
  readonly enabling: string
}

export function EnableButton({ address, state, enabling }: EnableButtonProps) {
  const [isAsked, setAsked] = useState(false)
  const mayOperate = useLive((s) => s.role === 'operator')
  const obstacle = enableObstacle(state, mayOperate)
  return (
    <>
      <CommandButton
        label={`Enable ${address}…`}
        tone="strong"
        icon={<IconLockOpen size={14} aria-hidden />}
        obstacle={obstacle}
        onPress={() => setAsked(true)}
      />
      {obstacle && (
        <Text size="xs" c="dimmed">
          Not now: {obstacle}.
        </Text>
      )}
      <Modal
        opened={isAsked}
        onClose={() => setAsked(false)}
        title={`Enable ${address}?`}
        centered
        closeButtonProps={{ 'aria-label': 'Close' }}
      >
        <EnableForm address={address} enabling={enabling} onDone={() => setAsked(false)} />
      </Modal>
    </>
  )
}

const SHORTEST = 3

interface EnableFormProps {
  readonly address: string
  readonly enabling: string
  readonly onDone: () => void
}

function EnableForm({ address, enabling, onDone }: EnableFormProps) {
  const [reason, setReason] = useState('')
  const [problem, setProblem] = useState('')
  const [isBusy, setBusy] = useState(false)
  const name = useLive((s) => s.present.find((each) => each.page === s.page)?.name ?? '')
  const isTooShort = reason.trim().length < SHORTEST

  function send(): void {
    setBusy(true)
    setProblem('')
    enableDevice(address, reason.trim())
      .then(onDone, (error: unknown) => setProblem(wordsOf(error)))
      .finally(() => setBusy(false))
  }

  return (
    <form
      noValidate
      onSubmit={(event) => {
        event.preventDefault()
        if (!isTooShort && !isBusy) send()
      }}
    >
      <Stack gap="sm">
        <Text size="sm">{enabling}</Text>
        <Text size="sm">It may move from then on. Look that nobody is in its reach, and have the emergency stop at hand.</Text>
        <TextInput
          label="Reason"
          description={`It is logged${name && `, with your name: ${name}`}`}
          withAsterisk
          data-autofocus
          maxLength={500}
          value={reason}
          onChange={(event) => setReason(event.currentTarget.value)}
        />
        <DialogFooter refusal={problem} onCancel={onDone}>
          <Button type="submit" disabled={isTooShort} loading={isBusy}>
            Enable
          </Button>
        </DialogFooter>
      </Stack>
    </form>
  )
}
