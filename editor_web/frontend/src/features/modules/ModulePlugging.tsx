/** Plugs a module into a connector and unplugs it; a run that has the module is stopped for that only when a person says so. */
import { Button, Group, NativeSelect, Stack, Text, Title } from '@mantine/core'
import { IconPlug, IconPlugOff } from '@tabler/icons-react'
import { useState } from 'react'
import { bus } from '../../api/bus'
import { wordsOf } from '../../api/client'
import { useData } from '../../api/data'
import type { LeaseMetrics } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { Dialog } from '../../components/Dialog'
import { DialogFooter } from '../../components/DialogFooter'
import { Refusal } from '../../components/Refusal'
import type { Dict } from '../../document/dict'
import { firstOfPath } from '../../document/path'

const TOPIC = 'cell/modules'

/** What the topic says of all modules. */
interface Modules {
  readonly modules: readonly { readonly module: string; readonly connector: string }[]
  readonly free: readonly string[]
}

export function ModulePlugging({ module }: { readonly module: string }) {
  const [known, setKnown] = useState<Modules>()
  const [leases, setLeases] = useState<readonly LeaseMetrics[]>([])
  const [chosen, setChosen] = useState('')
  const [problem, setProblem] = useState('')
  const [isBusy, setBusy] = useState(false)
  const [isAsked, setAsked] = useState(false)
  useData({ number: 0, traffic: true, topic: TOPIC, fields: [], run: '', goals: '', cell: false }, (frame) => {
    if (frame.k === 'traffic') setLeases(frame.leases)
    if (frame.k === 'message' && frame.topic === TOPIC && !frame.problem) setKnown(frame.value as Modules)
  })
  const at = known?.modules.find((each) => each.module === module)?.connector
  if (!known || at === undefined) return null
  const lease = leases.find((each) => firstOfPath(each.resource) === module)
  const goal = known.free.includes(chosen) ? chosen : known.free[0]

  function send(service: string, request: Dict<unknown>): void {
    setBusy(true)
    setProblem('')
    bus
      .call(`${module}/${service}`, request)
      .then(() => setAsked(false))
      .catch((error: unknown) => setProblem(wordsOf(error)))
      .finally(() => setBusy(false))
  }

  return (
    <section aria-label="Connector">
      <Stack gap={4} align="flex-start">
        <Title order={3} size="sm">
          Connector
        </Title>
        {at ? (
          <CommandButton
            label={lease ? 'Unplug…' : 'Unplug'}
            hint={`Takes it from ${at}, with the parts that are on it`}
            obstacle={isBusy ? 'the answer is awaited' : undefined}
            icon={<IconPlugOff size={14} aria-hidden />}
            onPress={() => (lease ? setAsked(true) : send('unplug_module', {}))}
          />
        ) : (
          <Group gap="xs" align="end">
            <NativeSelect
              size="xs"
              label="To"
              value={goal ?? ''}
              data={[...known.free]}
              disabled={known.free.length === 0}
              onChange={(event) => setChosen(event.currentTarget.value)}
            />
            <CommandButton
              label="Plug"
              obstacle={goal === undefined ? 'no connector is free' : isBusy ? 'the answer is awaited' : undefined}
              icon={<IconPlug size={14} aria-hidden />}
              onPress={() => send('plug_module', { connector: goal })}
            />
          </Group>
        )}
        {lease && (
          <Text size="xs" c="dimmed">
            {holder(lease)} has it.
          </Text>
        )}
        {!isAsked && <Refusal onClose={() => setProblem('')}>{problem}</Refusal>}
      </Stack>
      <Dialog isOpen={isAsked} onClose={() => setAsked(false)} title={`Unplug ${module}?`}>
        <Stack gap="sm">
          <Text size="sm">
            {lease ? `${holder(lease)} has it. That run is stopped first: all that it moves comes to rest.` : 'No run has it any more.'}
          </Text>
          <DialogFooter refusal={problem} onCancel={() => setAsked(false)}>
            <Button color="red" loading={isBusy} onClick={() => send('unplug_module', { end_run: true })}>
              {lease ? 'Stop the run and unplug' : 'Unplug'}
            </Button>
          </DialogFooter>
        </Stack>
      </Dialog>
    </section>
  )
}

function holder({ run, node }: LeaseMetrics): string {
  return node ? `Run ${run} at ${node}` : `Run ${run}`
}
