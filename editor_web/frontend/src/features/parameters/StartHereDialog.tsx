/** Starts a run at a node with the data of an earlier one, or one that pauses before a node. */
import { Alert, Button, Group, Stack, Text, Textarea } from '@mantine/core'
import { skipToken } from '@tanstack/react-query'
import { useEffect, useState } from 'react'
import { behaviorQueries } from '../../api/behaviorQueries'
import { useLive } from '../../api/live'
import { useAnswer } from '../../api/queryClient'
import { askStartHere, goOnTo, useStartHere, type StartHere } from '../../api/startHere'
import type { BehaviorView, StartBody, StartData } from '../../api/types'
import { Dialog } from '../../components/Dialog'
import { ParameterField } from '../../components/ParameterField'
import { lookup } from '../../document/dict'
import { nameOfPath } from '../../document/path'
import { useOffers } from './useOffers'
import { useStart } from './useStart'

export interface StartHereDialogProps {
  readonly behavior: BehaviorView
  /** Why it cannot be started now; undefined when it can. */
  readonly obstacle: string | undefined
  readonly onStarted: () => void
}

export function StartHereDialog(props: StartHereDialogProps) {
  const asked = useStartHere((s) => s.asked)
  const isActive = useLive((s) => s.control !== undefined && s.control !== null)
  const here = asked?.behavior === props.behavior.id ? asked : undefined
  const query = behaviorQueries.startData(here?.behavior ?? '', here?.path ?? '')
  const { value, problem } = useAnswer({ ...query, ...(!here && { queryFn: skipToken }) })
  if (!here) return null
  const name = nameOfPath(here.path)
  const found = problem ?? value
  const close = () => askStartHere(undefined)
  return (
    <Dialog isOpen title={here.kind === 'from' ? `Run from ${name}` : `Run to ${name}`} onClose={close}>
      {here.kind === 'to' && isActive ? (
        <GoOn here={here} onDone={close} />
      ) : typeof found === 'string' ? (
        <Alert color="red">{found}</Alert>
      ) : (
        found && <StartForm key={`${here.kind} ${here.path}`} {...props} here={here} found={found} onDone={close} />
      )}
    </Dialog>
  )
}

function GoOn({ here, onDone }: { here: StartHere; onDone: () => void }) {
  return (
    <Stack gap="sm">
      <Text size="sm">The active run goes on, and pauses before this node.</Text>
      <Group justify="flex-end">
        <Button onClick={() => void goOnTo(here.path).then((isDone) => isDone && onDone())}>Go on</Button>
      </Group>
    </Stack>
  )
}

type StartFormProps = StartHereDialogProps & { readonly here: StartHere; readonly found: StartData; readonly onDone: () => void }

function placeOf(here: StartHere, found: StartData): Pick<StartBody, 'begin' | 'until'> {
  if (here.kind === 'to') return { until: here.path }
  return { begin: found.run ? { run: found.run, seq: found.seq, path: here.path } : { path: here.path } }
}

function StartForm({ behavior, obstacle, onStarted, here, found, onDone }: StartFormProps) {
  const started = () => {
    onDone()
    onStarted()
  }
  const { fields, values, set, problems, fill, submit, inputs, setInputs, inputsProblem } = useStart(
    behavior,
    started,
    placeOf(here, found),
  )
  const offersOf = useOffers(fields)
  const [isFilled, setFilled] = useState(false)
  useEffect(() => {
    if (isFilled || here.kind === 'to') return
    setFilled(true)
    fill(found.parameters, found.userdata)
  }, [isFilled, here, found, fill])
  const reason = here.kind === 'from' && found.obstacle ? found.obstacle : obstacle
  return (
    <form
      aria-label="Start here"
      noValidate
      onSubmit={(event) => {
        event.preventDefault()
        if (reason === undefined) void submit()
      }}
    >
      <Stack gap={14} maw="34rem">
        <Text size="sm">{wordsFor(here, found)}</Text>
        {reason && <Alert color="red">{reason}</Alert>}
        {fields.map((field) => (
          <ParameterField
            key={field.name}
            field={field}
            value={lookup(values, field.name)}
            problem={lookup(problems, field.name)}
            offers={offersOf(field)}
            onChange={(value) => set(field.name, value)}
          />
        ))}
        <Textarea
          size="sm"
          label="Userdata"
          description="As a JSON object; keys that are left out keep their values"
          styles={{ input: { fontFamily: 'var(--mantine-font-family-monospace)' } }}
          autosize
          minRows={2}
          maxRows={12}
          value={inputs}
          error={inputsProblem}
          onChange={(event) => setInputs(event.currentTarget.value)}
        />
        <Group justify="flex-end">
          <Button type="submit" disabled={reason !== undefined}>
            Start
          </Button>
        </Group>
      </Stack>
    </form>
  )
}

function wordsFor(here: StartHere, found: StartData): string {
  if (here.kind === 'to') return 'A new run starts at the beginning and pauses before this node.'
  if (!found.run) return 'No earlier run has entered this node: it starts with the initial values. Nothing is moved or restored first.'
  return `A new run starts at this node, with the data that run ${found.run} had when it last entered it. Nothing is moved or restored first.`
}
