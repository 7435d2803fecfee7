/** The step of the recovery that lets real devices move again. */
import { Text } from '@mantine/core'
import type { ReactNode } from 'react'
import type { CellStop, DeviceRecovery } from '../../api/types'
import { StepRow } from './ArmSteps'

interface EnableStepProps {
  readonly stop: CellStop
  readonly renderEnable: (device: DeviceRecovery) => ReactNode
}

export function EnableStep({ stop: { real }, renderEnable }: EnableStepProps) {
  if (real.length === 0) return <Text size="sm">This cell has no real devices now.</Text>
  return (
    <>
      {real.map((device) => (
        <StepRow key={device.name} label={device.name} tools={!device.enabled && renderEnable(device)}>
          <strong>{device.name}</strong> {device.enabled ? 'may move' : `may not move: ${device.problem}`}
        </StepRow>
      ))}
      <Text size="sm" c="dimmed">
        Going home, jogging and opening a tool need it. Look at the device, and clear the cause there, before you enable it.
      </Text>
    </>
  )
}
