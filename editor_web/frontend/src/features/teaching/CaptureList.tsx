/** The buffer: what was captured and waits to be looked at, compared, saved or discarded. */
import { lookup } from '../../document/dict'
import { Checkbox } from '@mantine/core'
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
import { FORM_WORDS } from './forms'
import { PlayBack } from './PlayBack'
import { poseWords } from './poseWords'
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
    <div className="captures">
      <ul className="plain-list capture-list" aria-label="Captures">
        {captures.map((each) => (
          <li key={each.id} className={`capture${each.id === one?.id ? ' is-current' : ''}`}>
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
            <button type="button" className="capture-name" aria-pressed={each.id === one?.id} onClick={() => setChosen(each.id)}>
              <span>
                {each.id} · {FORM_WORDS[each.form]}
              </span>
              <span className="quiet">{summaryWords(each)}</span>
            </button>
          </li>
        ))}
      </ul>
      {beside.length > 0 && (
        <section aria-label="Comparison" className="teach-part">
          <h3>Side by side</h3>
          <Comparison things={beside.map((each) => asCompared(each, arm))} />
        </section>
      )}
      {one && <Details key={one.id} arm={arm} capture={one} />}
    </div>
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
  return (
    <section className="teach-part" aria-label={`Capture ${capture.id}`}>
      <h3>
        {FORM_WORDS[capture.form]} {capture.id}
      </h3>
      <dl className="facts">
        <dt>Taken by</dt>
        <dd>{capture.trigger}</dd>
        {joints && (
          <>
            <dt>{capture.samples > 0 ? 'Ends at joints' : 'Joints'}</dt>
            <dd className="mono">{joints.map((value) => `${degrees(value).toFixed(1)}°`).join('  ')}</dd>
          </>
        )}
        {place?.frame && (
          <>
            <dt>In {place.frame}</dt>
            <dd className="mono">{poseWords([...place.xyz, ...(place.xyzw ?? [0, 0, 0, 1])])}</dd>
          </>
        )}
        {pose && (
          <>
            <dt>{capture.samples > 0 ? 'Ends at pose' : 'Pose'}</dt>
            <dd className="mono">{poseWords(pose)}</dd>
          </>
        )}
        {capture.samples > 0 && (
          <>
            <dt>Motion</dt>
            <dd>
              {duration(capture.duration_s)}, {capture.samples} samples, {degrees(capture.length_rad).toFixed(0)}° of joints in all,{' '}
              {degrees(capture.peak_rad_s).toFixed(0)}°/s at most
            </dd>
            <dt>Learned</dt>
            <dd>{fitWords(fit)}</dd>
          </>
        )}
        {(capture.remark || last?.remark || unfit) && (
          <>
            <dt>Remark</dt>
            <dd>{capture.remark || last?.remark || unfit}</dd>
          </>
        )}
      </dl>
      {capture.samples > 0 && fit && <Comparison things={[asCompared(capture, arm)]} />}
      <div className="command-row">
        <CommandButton label="Show in the cell" icon={<IconEye size={15} aria-hidden />} onPress={look} />
        <CommandButton
          label="Discard"
          tone="quiet"
          icon={<IconTrash size={15} aria-hidden />}
          obstacle={off}
          onPress={() => void teach.discard(capture.id).then(undefined, (error: unknown) => setProblem(wordsOf(error)))}
        />
      </div>
      {(problem || looked) && (
        <p className="teach-problem" role="alert">
          {problem || looked?.message}
        </p>
      )}
      {capture.form !== 'gripper' && (
        <PlayBack arm={robot} what={{ kind: '', name: '', capture: capture.id }} words={`capture ${capture.id}`} onLook={look} />
      )}
      <SaveForm key={capture.id} capture={capture} fit={fit} arm={robot} />
    </section>
  )
}

/** Where a captured pose is in its own frame, where that is not the world. */
function usePlace({ id, form }: CaptureSummary): NonNullable<Capture['pose']> | undefined {
  const place = useAnswer({ ...entryQueries.capture(id), enabled: form === 'pose' }).value?.pose
  return place && place.frame !== undefined && place.frame !== 'world' ? place : undefined
}
