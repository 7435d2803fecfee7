/** The form that sets a behavior's parameters for one run. */
import { lookup } from '../../document/dict'
import { Alert, Button, Code, Collapse, NumberInput, Stack, Text, Textarea } from '@mantine/core'
import { IconAlertTriangle, IconChevronDown, IconChevronRight, IconRepeat } from '@tabler/icons-react'
import { useState, type ReactNode } from 'react'
import type { BehaviorView } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { ParameterField } from '../../components/ParameterField'
import { Words } from '../../components/Words'
import { StartOptions } from './StartOptions'
import { useOffers } from './useOffers'
import { useSharedStart } from './StartProvider'

/** The id by which the Start button belongs to the form. */
export const FORM_ID = 'parameters'

const MONOSPACE = { input: { fontFamily: 'var(--mantine-font-family-monospace)' } }

export interface ParameterFormProps {
  readonly behavior: BehaviorView
  /** Where it will run, in words. */
  readonly place: string
  /** The command line that runs it in virtual time, which a server does not. */
  readonly terminal: string
  /** The run that is shown, whose values can be taken over. */
  readonly run: string | undefined
}

export function ParameterForm({ behavior, place, terminal, run }: ParameterFormProps) {
  const start = useSharedStart()
  if (start.damage) throw start.damage
  const offersOf = useOffers(start.fields)
  const { fields, values, set, problems, repeat, seed, setSeed } = start
  return (
    <form id={FORM_ID} noValidate aria-label="Parameters" onSubmit={(event) => event.preventDefault()}>
      <Stack gap={14} maw="34rem">
        {behavior.fit.obstacle && (
          <Alert color="yellow" icon={<IconAlertTriangle size={16} aria-hidden />} title="It cannot be started here">
            <Words text={behavior.fit.obstacle} />
          </Alert>
        )}
        {fields.length === 0 && (
          <Text size="sm" c="var(--quiet)">
            This behavior has no parameters.
          </Text>
        )}
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
        <Disclosure title="Operation">
          <StartOptions supervision={start.supervision} onChange={start.setSupervision} hasBreakpoints={start.hasBreakpoints} />
        </Disclosure>
        <Disclosure title="Initial userdata">
          <Textarea
            size="sm"
            label="Userdata"
            description={'Values to begin with in the place of those of the document, as JSON: {"count": 3}'}
            styles={MONOSPACE}
            autosize
            minRows={2}
            value={start.inputs}
            error={start.inputsProblem}
            onChange={(event) => start.setInputs(event.currentTarget.value)}
          />
        </Disclosure>
        <Disclosure title="Repeatability">
          <NumberInput
            size="sm"
            label="Seed"
            description="The same seed draws the same random numbers; empty draws a new one"
            value={seed}
            onChange={setSeed}
            min={0}
            max={2 ** 31 - 1}
            allowDecimal={false}
          />
        </Disclosure>
        {run !== undefined && (
          <div>
            <CommandButton
              label="Same as the shown run"
              hint="Fill in the parameters, userdata and seed that the shown run was started with"
              icon={<IconRepeat size={15} aria-hidden />}
              onPress={() => void repeat(run)}
            />
          </div>
        )}
        <Text size="sm" c="var(--quiet)">
          {place}
        </Text>
        <Disclosure title="Another cell or clock">
          <Text size="sm" c="var(--quiet)">
            The cell is chosen when the server starts: <Code>flexcell serve --cell …</Code>. It goes by the real clock; in virtual time, as
            fast as can be computed, a behavior is run on the terminal: <Code>{terminal}</Code>
          </Text>
        </Disclosure>
      </Stack>
    </form>
  )
}

function Disclosure({ title, children }: { title: string; children: ReactNode }) {
  const [isOpen, setOpen] = useState(false)
  const Chevron = isOpen ? IconChevronDown : IconChevronRight
  return (
    <div>
      <Button
        variant="subtle"
        color="gray"
        size="compact-sm"
        px={0}
        fw={400}
        c="var(--quiet)"
        leftSection={<Chevron size={14} aria-hidden />}
        styles={{ section: { marginInlineEnd: 4 } }}
        aria-expanded={isOpen}
        onClick={() => setOpen(!isOpen)}
      >
        {title}
      </Button>
      <Collapse expanded={isOpen}>
        <Stack gap="sm" mt="2xs">
          {children}
        </Stack>
      </Collapse>
    </div>
  )
}
