/** One device with a driver: what it does and may do now, what its driver can do, and its options. */
import { Group, Stack, Table, Text, Title } from '@mantine/core'
import type { ReactNode } from 'react'
import type { DeviceDetails, DeviceNow } from '../../api/types'
import { StatusIcon } from '../../components/StatusIcon'
import { deviceMode, linkWords } from '../../document/devices'
import { wallTime } from '../../document/time'
import { DriverOptions } from './DriverOptions'
import { EnableButton } from './EnableButton'

interface DevicePanelProps {
  readonly details: DeviceDetails
  /** What it tells now; undefined of one that is simulated. */
  readonly now: DeviceNow | undefined
}

const STALE_S = 0.5

export function DevicePanel({ details, now }: DevicePanelProps) {
  return (
    <>
      {!details.simulated && (
        <section aria-label="Real device">
          <Stack gap={4} align="flex-start">
            <Title order={3} size="sm">
              Real device
            </Title>
            <Now details={details} now={now} />
            {!now?.state.enabled && <EnableButton address={details.address} state={now?.state} enabling={details.enabling} />}
          </Stack>
        </section>
      )}
      <section aria-label="Driver">
        <Stack gap={4}>
          <Title order={3} size="sm">
            Driver {details.driver}
          </Title>
          {details.problem && (
            <Text size="sm" c="var(--failed)">
              {details.problem}
            </Text>
          )}
          <Table variant="vertical" withTableBorder aria-label={`Driver of ${details.device}`}>
            <Table.Tbody>
              {details.proven && <Row name="Proven">{details.proven}</Row>}
              {details.can.length > 0 && <Row name="Can do">{details.can.join(', ')}</Row>}
              {details.cannot.length > 0 && <Row name="Cannot do">{details.cannot.join(', ')}</Row>}
              {details.page && <Row name="Setup">{details.page}</Row>}
            </Table.Tbody>
          </Table>
          <DriverOptions details={details} />
        </Stack>
      </section>
    </>
  )
}

function Now({ details, now }: DevicePanelProps) {
  if (!now) return <Text size="sm">Nothing is known of it yet.</Text>
  const { state, link } = now
  const { words, look } = deviceMode(state)
  return (
    <Table variant="vertical" withTableBorder tabularNums aria-label={`Device ${details.address}`}>
      <Table.Tbody>
        <Row name="State">
          <Group gap={5} wrap="nowrap">
            <StatusIcon status={look} size={14} />
            <strong>{words}</strong>
          </Group>
          {state.problem}
        </Row>
        {state.safety && <Row name="Safety state">{state.safety}</Row>}
        {state.last_cause && (
          <Row name="Last stopped">
            {wallTime(state.last_cause_unix_s)}: {state.last_cause}
          </Row>
        )}
        {state.enabled_for && (
          <Row name="Enabled last">
            {state.enabled_by || 'without a name'}: {state.enabled_for}
          </Row>
        )}
        <Row name="Firmware">{state.firmware || 'the device does not report it'}</Row>
        {typeof link?.speed_scaling === 'number' && <Row name="Speed scaling">{Math.round(link.speed_scaling * 100)} %</Row>}
        {link && (
          <Row name="Connection">
            {linkWords(link)};{' '}
            <Text span inherit c={link.age_s > STALE_S ? 'var(--failed)' : 'inherit'}>
              the last one is {link.age_s.toFixed(2)} s old
            </Text>
          </Row>
        )}
        <Row name="Address">{state.address}</Row>
      </Table.Tbody>
    </Table>
  )
}

function Row({ name, children }: { readonly name: string; readonly children: ReactNode }) {
  return (
    <Table.Tr>
      <Table.Th w="8rem">{name}</Table.Th>
      <Table.Td style={{ overflowWrap: 'anywhere' }}>{children}</Table.Td>
    </Table.Tr>
  )
}
