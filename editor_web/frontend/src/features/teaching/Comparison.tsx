/** Things taught side by side: over time, each beside the primitive learned from it, and together in the cell. */
import { lookup, type Dict } from '../../document/dict'
import { Flex, Group, NativeSelect, Stack, Table, Text } from '@mantine/core'
import { IconEye } from '@tabler/icons-react'
import { useQueries } from '@tanstack/react-query'
import { useState } from 'react'
import { entryQueries } from '../../api/entries'
import { problemOf } from '../../api/queryClient'
import { previewTaught, type TaughtReference } from '../../api/teaching'
import type { CaptureSummary, PrimitiveComparison, Trace } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { apart, changesOf, curveOf, degrees, endOf, errorsOf } from '../../document/teaching'
import { Chart, CurveKey, type Drawn } from './Chart'
import { Refusal } from '../../components/Refusal'

/** As many as there are colours, here and in the cell. */
export const MOST_COMPARED = 5
const TOOL = ['Tool x', 'Tool y', 'Tool z']

/** Something taught, and the arm that it is shown with. */
export interface Compared {
  readonly key: string
  readonly label: string
  readonly arm: string
  readonly what: TaughtReference
}

export function asCompared(capture: CaptureSummary, arm: string): Compared {
  return { key: `${capture.id}`, label: `${capture.id}`, arm: capture.robot || arm, what: { kind: '', name: '', capture: capture.id } }
}

export function Comparison({ things }: { readonly things: readonly Compared[] }) {
  const [channel, setChannel] = useState('tool 0')
  const { fits, problem } = useFits(things)
  const joints = Math.max(0, ...things.map((each) => traceOf(lookup(fits, each.key))?.joints[0]?.length ?? 0))
  const isTool = channel.startsWith('tool')
  const unit = isTool ? 'mm' : '°'
  const curves = things.flatMap((each, at) => drawn(each, lookup(fits, each.key), channel, at))
  const learned = things.filter((each) => lookup(fits, each.key)?.demonstration && lookup(fits, each.key)?.primitive)
  return (
    <Stack gap="xs">
      {curves.length > 0 && (
        <>
          <NativeSelect
            size="xs"
            label="Show over time"
            value={channel}
            onChange={(event) => setChannel(event.currentTarget.value)}
            data={[
              ...TOOL.map((label, at) => ({ value: `tool ${at}`, label })),
              ...Array.from({ length: joints }, (_, at) => ({ value: `joint ${at}`, label: `Joint ${at + 1}` })),
            ]}
          />
          <Chart
            curves={curves}
            unit={unit}
            label={`${curves.length} curves, ${isTool ? TOOL[Number(channel.at(-1))] : `joint ${Number(channel.at(-1)) + 1}`} over time`}
          />
        </>
      )}
      <Refusal>{problem}</Refusal>
      {learned.length > 0 && (
        <Table fz="xs" verticalSpacing={4} horizontalSpacing="xs" aria-label="Learned against shown">
          <Table.Thead>
            <Table.Tr>
              <Table.Th scope="col">Learned against shown</Table.Th>
              <Table.Th scope="col">What is drawn</Table.Th>
              <Table.Th scope="col">Joints</Table.Th>
              <Table.Th scope="col">Tool</Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {learned.map((each) => (
              <Table.Tr key={each.key}>
                <Table.Th scope="row">{each.label}</Table.Th>
                <Table.Td>{apartWords(lookup(fits, each.key), channel, unit)}</Table.Td>
                <Table.Td>{jointErrorWords(lookup(fits, each.key))}</Table.Td>
                <Table.Td>{toolErrorWords(lookup(fits, each.key))}</Table.Td>
              </Table.Tr>
            ))}
          </Table.Tbody>
        </Table>
      )}
      {things.length > 1 && <Differences things={things} fits={fits} />}
      {things.length > 1 && (
        <Group>
          <CommandButton
            label="Show all in the cell"
            hint="Each in the colour that it has here"
            icon={<IconEye size={15} aria-hidden />}
            onPress={() => things.forEach((each, at) => previewTaught(each.arm, each.what, at))}
          />
        </Group>
      )}
    </Stack>
  )
}

/** In what the others are not the first. */
function Differences({ things, fits }: { readonly things: readonly Compared[]; readonly fits: Dict<PrimitiveComparison> }) {
  const [first, ...others] = things
  const before = first && traceOf(lookup(fits, first.key))
  if (!first || !before) return null
  return (
    <Flex component="ul" direction="column" gap={4} m={0} p={0} style={{ listStyle: 'none' }} aria-label={`Against ${first.label}`}>
      <li>
        <CurveKey name={first.label} colour={0} />
      </li>
      {others.map((each, at) => {
        const after = traceOf(lookup(fits, each.key))
        return (
          <Flex component="li" key={each.key} wrap="wrap" columnGap="xs">
            <CurveKey name={each.label} colour={at + 1} />
            <Text span size="sm" c="dimmed">
              {after ? `against ${first.label}: ${differencesOf(before, after).join(', ')}` : ''}
            </Text>
          </Flex>
        )
      })}
    </Flex>
  )
}

/** Of a motion and a place it is the end of the motion that counts. */
function differencesOf(before: Trace, after: Trace): readonly string[] {
  const isMotion = before.poses.length > 1 && after.poses.length > 1
  return isMotion ? changesOf(before, after) : changesOf(endOf(before), endOf(after))
}

function traceOf(fit: PrimitiveComparison | undefined): Trace | undefined {
  return fit?.demonstration ?? fit?.primitive ?? undefined
}

function drawn(thing: Compared, fit: PrimitiveComparison | undefined, channel: string, at: number): readonly Drawn[] {
  const colour = at % MOST_COMPARED
  const made: Drawn[] = []
  if (fit?.demonstration)
    made.push({ ...curveOf(fit.demonstration, fit.primitive ? `${thing.label} shown` : thing.label, channel), colour, isDashed: false })
  if (fit?.primitive)
    made.push({
      ...curveOf(fit.primitive, fit.demonstration ? `${thing.label} learned` : thing.label, channel),
      colour,
      isDashed: fit.demonstration !== null,
    })
  return made.filter((curve) => curve.values.length > 1)
}

function apartWords(fit: PrimitiveComparison | undefined, channel: string, unit: string): string {
  if (!fit?.demonstration || !fit.primitive) return '–'
  const found = apart(curveOf(fit.demonstration, '', channel), curveOf(fit.primitive, '', channel))
  return found ? `${found.rms.toFixed(2)} ${unit} RMS, ${found.most.toFixed(2)} ${unit} at most` : '–'
}

function jointErrorWords(fit: PrimitiveComparison | undefined): string {
  const found = fit?.demonstration && fit.primitive ? errorsOf(fit.demonstration, fit.primitive).joints : undefined
  return found ? `${degrees(found.rms).toFixed(3)}° RMS, ${degrees(found.most).toFixed(3)}° at most` : '–'
}

function toolErrorWords(fit: PrimitiveComparison | undefined): string {
  const found = fit?.demonstration && fit.primitive ? errorsOf(fit.demonstration, fit.primitive).tool : undefined
  return found ? `${(found.rms * 1000).toFixed(2)} mm RMS, ${(found.most * 1000).toFixed(2)} mm at most` : '–'
}

/** What was learned, and how far that is from the demonstration: of the joints and of the tool. */
export function fitWords(fit: PrimitiveComparison | undefined): string {
  const own = fit?.cart_fit ?? fit?.joint_fit
  return own ? `${own.kernels} kernels; joints ${jointErrorWords(fit)}; tool ${toolErrorWords(fit)}` : '–'
}

/** Where an arm is along things, each asked for once. */
export function useFits(things: readonly Compared[]): { readonly fits: Dict<PrimitiveComparison>; readonly problem: string } {
  const answers = useQueries({ queries: things.map(({ arm, what }) => entryQueries.fits(arm, what)) })
  const fits = Object.fromEntries(
    things.flatMap(({ key }, at) => {
      const found = answers[at]?.data
      return found ? [[key, found] as const] : []
    }),
  )
  const problems = things.map(({ label }, at) => {
    const problem = problemOf(answers[at]?.error ?? null)
    return problem && `${label}: ${problem}`
  })
  return { fits, problem: problems.findLast((each) => each !== undefined) ?? '' }
}
