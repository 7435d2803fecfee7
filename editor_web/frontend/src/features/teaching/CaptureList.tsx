/** The buffer: what was captured and waits to be looked at, compared, saved or discarded. */
import { lookup } from '../../document/dict'
import { Checkbox, Group, Stack, Text, UnstyledButton } from '@mantine/core'
import { IconEye, IconTrash } from '@tabler/icons-react'
import { useState } from 'react'
import { wordsOf } from '../../api/client'
import { entryQueries } from '../../api/entries'
import { useAnswer } from '../../api/queryClient'
import { previewTaught, teach, useDisabledReason, useTeach } from '../../api/teaching'
import type { Capture, CaptureSummary } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { Empty } from '../../components/Empty'
import { degrees } from '../../document/teaching'
import { duration, wallTime } from '../../document/time'
import { asCompared, Comparison, fitWords, MOST_COMPARED, useFits } from './Comparison'
import classes from './Choices.module.css'
import { FORM_WORDS } from './forms'
import { Facts } from './Facts'
import { Part } from './Part'
import { PlayBack } from './PlayBack'
import { poseWords } from './poseWords'
import { Refusal } from '../../components/Refusal'
import { SaveForm } from './SaveForm'

export function CaptureList({ arm }: { readonly arm: string }) {
  const hand = useTeach((s) => s.hand)
  const [chosen, setChosen] = useState<number>()
  const [compared, setCompared] = useState<readonly number[]>([])
  const captures = (hand?.captures ?? []).toReversed()
  const one = captures.find((each) => each.id === chosen) ?? captures[0]
  const beside = captures.filter((each) => compared.includes(each.id))
  if (captures.length === 0) {
    return (
      <Empty title="Nothing is captured">
        Press Joints, Pose or Record above, or the button of a trigger. Captures stay here until they are saved or discarded.
      </Empty>
    )
  }
  return (
    <Stack gap="xs">
      <ul className={`${classes.list} plain-list`} aria-label="Captures">
        {captures.map((each) => (
          <li key={each.id}>
            <Checkbox
              size="xs"
              aria-label={`Compare capture ${each.id}`}
              title="Compare"
              checked={compared.includes(each.id)}
              disabled={each.form === 'gripper' || (beside.length >= MOST_COMPARED && !compared.includes(each.id))}
              onChange={(event) =>
                setCompared(event.currentTarget.checked ? [...compared, each.id] : compared.filter((id) => id !== each.id))
              }
            />
            <UnstyledButton flex={1} miw={0} py={6} pr="xs" aria-pressed={each.id === one?.id} onClick={() => setChosen(each.id)}>
              <Text span size="sm" display="block">
                {each.id} · {FORM_WORDS[each.form]}
              </Text>
              <Text span size="xs" display="block" c="dimmed" truncate>
                {summaryWords(each)}
              </Text>
            </UnstyledButton>
          </li>
        ))}
      </ul>
      {beside.length > 0 && (
        <Part label="Comparison" title="Side by side">
          <Comparison things={beside.map((each) => asCompared(each, arm))} />
        </Part>
      )}
      {one && <Details key={one.id} arm={arm} capture={one} />}
    </Stack>
  )
}

function summaryWords(capture: CaptureSummary): string {
  const parts = [capture.robot, wallTime(capture.taken_at_s)]
  if (capture.samples > 0) parts.push(duration(capture.duration_s))
  if (capture.saved_as.length > 0) parts.push(`saved as ${capture.saved_as.join(', ')}`)
  return parts.filter(Boolean).join(' · ')
}

function Details({ arm, capture }: { readonly arm: string; readonly capture: CaptureSummary }) {
  const off = useDisabledReason()
  const looked = useTeach((s) => s.refused.look)
  const [problem, setProblem] = useState('')
  const robot = capture.robot || arm
  const { fits, problem: unfit } = useFits(capture.form === 'gripper' ? [] : [asCompared(capture, arm)])
  const fit = lookup(fits, capture.id)
  const last = fit?.demonstration
  const place = usePlace(capture)
  const pose = last?.poses.at(-1)
  const look = () => previewTaught(robot, { kind: '', name: '', capture: capture.id })
  const joints = last?.joints.at(-1)
  const isMotion = capture.samples > 0
  const remark = capture.remark || last?.remark || unfit
  return (
    <Part label={`Capture ${capture.id}`} title={`${FORM_WORDS[capture.form]} ${capture.id}`}>
      <Facts
        facts={[
          { name: 'Taken by', value: capture.trigger },
          joints && {
            name: isMotion ? 'Ends at joints' : 'Joints',
            value: joints.map((value) => `${degrees(value).toFixed(1)}°`).join('  '),
            isCode: true,
          },
          place?.frame !== undefined &&
            place.frame !== '' && {
              name: `In ${place.frame}`,
              value: poseWords([...place.xyz, ...(place.xyzw ?? [0, 0, 0, 1])]),
              isCode: true,
            },
          pose && { name: isMotion ? 'Ends at pose' : 'Pose', value: poseWords(pose), isCode: true },
          isMotion && { name: 'Motion', value: motionWords(capture) },
          isMotion && { name: 'Learned', value: fitWords(fit) },
          remark !== '' && { name: 'Remark', value: remark },
        ]}
      />
      {isMotion && fit && <Comparison things={[asCompared(capture, arm)]} />}
      <Group gap={6}>
        <CommandButton label="Show in the cell" icon={<IconEye size={15} aria-hidden />} onPress={look} />
        <CommandButton
          label="Discard"
          tone="quiet"
          icon={<IconTrash size={15} aria-hidden />}
          obstacle={off}
          onPress={() => void teach.discard(capture.id).then(undefined, (error: unknown) => setProblem(wordsOf(error)))}
        />
      </Group>
      <Refusal>{problem || looked?.message}</Refusal>
      {capture.form !== 'gripper' && (
        <PlayBack arm={robot} what={{ kind: '', name: '', capture: capture.id }} words={`capture ${capture.id}`} onLook={look} />
      )}
      <SaveForm key={capture.id} capture={capture} fit={fit} arm={robot} />
    </Part>
  )
}

function motionWords(capture: CaptureSummary): string {
  const length = `${degrees(capture.length_rad).toFixed(0)}° of joints in all`
  return `${duration(capture.duration_s)}, ${capture.samples} samples, ${length}, ${degrees(capture.peak_rad_s).toFixed(0)}°/s at most`
}

/** Where a captured pose is in its own frame, where that is not the world. */
function usePlace({ id, form }: CaptureSummary): NonNullable<Capture['pose']> | undefined {
  const place = useAnswer({ ...entryQueries.capture(id), enabled: form === 'pose' }).value?.pose
  return place && place.frame !== undefined && place.frame !== 'world' ? place : undefined
}
