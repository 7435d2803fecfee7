/** Switches devices between their drivers and the simulation: the cell is closed and opened anew. */
import { Button, Modal, Stack, Switch, Text } from '@mantine/core'
import { IconPlugConnected } from '@tabler/icons-react'
import { useState } from 'react'
import { DialogFooter } from '../../components/DialogFooter'
import { wordsOf } from '../../api/client'
import { switchSimulation } from '../../api/realDevices'
import type { DrivenDeviceChoice, SessionBody } from '../../api/types'

export function DriverSwitch({ session }: { readonly session: SessionBody | undefined }) {
  const [isOpen, setOpen] = useState(false)
  const devices = session?.devices ?? []
  if (devices.length === 0 || session?.role !== 'operator') return null
  return (
    <>
      <Button size="xs" variant="default" leftSection={<IconPlugConnected size={14} aria-hidden />} onClick={() => setOpen(true)}>
        Real or simulated
      </Button>
      <Modal opened={isOpen} onClose={() => setOpen(false)} title="Real or simulated" centered closeButtonProps={{ 'aria-label': 'Close' }}>
        {/* What is chosen belongs to the cell as it is open. */}
        <Devices key={session.epoch} devices={devices} onDone={() => setOpen(false)} />
      </Modal>
    </>
  )
}

function Devices({ devices, onDone }: { readonly devices: readonly DrivenDeviceChoice[]; readonly onDone: () => void }) {
  const [real, setReal] = useState(() => new Set(devices.filter((each) => !each.simulated).map((each) => each.device)))
  const [problem, setProblem] = useState<string>()
  const [isBusy, setBusy] = useState(false)
  const isSame = devices.every((each) => real.has(each.device) !== each.simulated)

  function choose(device: string, isReal: boolean): void {
    const others = [...real].filter((each) => each !== device)
    setReal(new Set(isReal ? [...others, device] : others))
  }

  function apply(): void {
    setBusy(true)
    switchSimulation(devices.map((each) => each.device).filter((each) => !real.has(each)))
      .then(onDone, (error: unknown) => setProblem(wordsOf(error)))
      .finally(() => setBusy(false))
  }

  return (
    <Stack gap="sm">
      {devices.map((each) => (
        <Switch
          key={each.device}
          label={`${each.device} is real`}
          description={real.has(each.device) ? `Driver ${each.driver}` : 'Simulated by the world of the cell'}
          checked={real.has(each.device)}
          onChange={(event) => choose(each.device, event.currentTarget.checked)}
        />
      ))}
      <Text size="sm">The cell is closed and opened anew. Nothing moves by this; simulated parts are back at their initial poses.</Text>
      <DialogFooter refusal={problem} onCancel={onDone}>
        <Button disabled={isSame} loading={isBusy} onClick={apply}>
          Open anew
        </Button>
      </DialogFooter>
    </Stack>
  )
}
