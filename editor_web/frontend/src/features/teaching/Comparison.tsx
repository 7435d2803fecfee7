/** Recordings side by side, and each beside the primitive learned from it. */
import { NativeSelect } from '@mantine/core'
import { useEffect, useState } from 'react'
import { wordsOf } from '../../api/client'
import { teach } from '../../api/teaching'
import type { CaptureSummary, Fits } from '../../api/types'
import { apart, curveOf, degrees } from '../../document/teaching'
import { Chart, type Drawn } from './Chart'

const COLOURS = 5
const TOOL = ['Tool x', 'Tool y', 'Tool z']

export function Comparison({ arm, captures }: { readonly arm: string; readonly captures: readonly CaptureSummary[] }) {
  const [channel, setChannel] = useState('tool 0')
  const { fits, problem } = useFits(arm, captures)
  const shown = captures.filter((each) => fits[each.id])
  const joints = Math.max(0, ...shown.map((each) => fits[each.id]?.demonstration?.joints[0]?.length ?? 0))
  const isTool = channel.startsWith('tool')
  const unit = isTool ? 'mm' : '°'
  const curves = shown.flatMap((each, at) => drawn(each, fits[each.id], channel, at))
  return (
    <div className="comparison">
      <NativeSelect
        size="xs"
        label="Show over time"
        value={channel}
        onChange={(event) => setChannel(event.currentTarget.value)}
        data={[...TOOL.map((label, at) => ({ value: `tool ${at}`, label })), ...Array.from({ length: joints }, (_, at) => ({ value: `joint ${at}`, label: `Joint ${at + 1}` }))]}
      />
      {curves.length > 0 && <Chart curves={curves} unit={unit} label={`${shown.length} recordings, ${isTool ? TOOL[Number(channel.at(-1))] : `joint ${Number(channel.at(-1)) + 1}`} over time`} />}
      {problem && (
        <p className="teach-problem" role="alert">
          {problem}
        </p>
      )}
      <table className="fit-table">
        <thead>
          <tr>
            <th scope="col">Recording</th>
            <th scope="col">Learned against shown, here</th>
            <th scope="col">Over the whole motion</th>
          </tr>
        </thead>
        <tbody>
          {shown.map((each) => (
            <tr key={each.id}>
              <th scope="row">{each.id}</th>
              <td>{apartWords(fits[each.id], channel, unit)}</td>
              <td>{fitWords(fits[each.id])}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  )
}

function drawn(capture: CaptureSummary, fit: Fits | undefined, channel: string, at: number): readonly Drawn[] {
  const colour = at % COLOURS
  const made: Drawn[] = []
  if (fit?.demonstration) made.push({ ...curveOf(fit.demonstration, `${capture.id} shown`, channel), colour, isDashed: false })
  if (fit?.primitive) made.push({ ...curveOf(fit.primitive, `${capture.id} learned`, channel), colour, isDashed: true })
  return made.filter((curve) => curve.values.length > 1)
}

function apartWords(fit: Fits | undefined, channel: string, unit: string): string {
  if (!fit?.demonstration || !fit.primitive) return '–'
  const found = apart(curveOf(fit.demonstration, '', channel), curveOf(fit.primitive, '', channel))
  return found ? `${found.rms.toFixed(2)} ${unit} RMS, ${found.most.toFixed(2)} ${unit} at most` : '–'
}

/** How far a primitive is from its demonstration. */
export function fitWords(fit: Fits | undefined): string {
  const cart = fit?.cart_fit
  if (cart) return `${(cart.rms_m * 1000).toFixed(2)} mm RMS, ${(cart.max_m * 1000).toFixed(2)} mm at most, ${cart.kernels} kernels`
  const joint = fit?.joint_fit
  return joint ? `${degrees(joint.rms_rad).toFixed(3)}° RMS, ${degrees(joint.max_rad).toFixed(3)}° at most, ${joint.kernels} kernels` : '–'
}

/** What is worked out of captures, each asked for once. */
export function useFits(arm: string, captures: readonly CaptureSummary[]): { readonly fits: Readonly<Record<number, Fits>>; readonly problem: string } {
  const [fits, setFits] = useState<Readonly<Record<number, Fits>>>({})
  const [problem, setProblem] = useState('')
  const key = captures.map((each) => each.id).join()
  useEffect(() => {
    let current = true
    for (const { id, robot, form } of captures) {
      if (form === 'gripper') continue
      teach.fits(robot || arm, { kind: '', name: '', capture: id }).then(
        (found) => current && setFits((known) => ({ ...known, [id]: found })),
        (error: unknown) => current && setProblem(wordsOf(error)),
      )
    }
    return () => {
      current = false
    }
    // eslint-disable-next-line react-hooks/exhaustive-deps -- a capture never changes, its number stands for it
  }, [arm, key])
  return { fits, problem }
}
