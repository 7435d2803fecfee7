/** A pose: taught in place with the tool, made of three points, or typed; in the world or seen from a frame of the cell. */
import { NativeSelect, SegmentedControl, Stack, Switch, Text } from '@mantine/core'
import { IconFocusCentered } from '@tabler/icons-react'
import { useState, type ReactNode } from 'react'
import { Refusal } from '../../components/Refusal'
import { useData } from '../../api/data'
import type { CellStateFrame } from '../../api/types'
import type { PoseRequest } from '../../api/valueWizard'
import { CommandButton } from '../../components/CommandButton'
import { fieldsOf, lookup, type Dict } from '../../document/dict'
import {
  angleAt,
  distance,
  FLIPPED,
  frameOf,
  inWorld,
  multiplied,
  NO_TURN,
  normalised,
  poseFrom,
  roundedTo,
  seenFrom,
  threePointFrame,
  turnOf,
  vectorFrom,
  WORLD,
  type PlacedPose,
  type Vector,
} from '../../document/poses'
import { degrees, rollPitchYaw } from '../../document/teaching'
import { TaughtArm, useArm, useArmObstacle, useTool } from './TaughtArm'
import { TaughtPoint } from './TaughtPoint'
import { useShownValue } from './useShownValue'
import { VectorFields } from '../../components/VectorFields'
import { WizardFrame } from './WizardFrame'

const TURN_DIGITS = 5

interface PoseWizardProps {
  readonly asked: PoseRequest
  readonly jog: (arm: string) => ReactNode
  readonly view: ReactNode
  readonly isNarrow: boolean
  readonly onClose: () => void
}

export function PoseWizard({ asked, jog, view, isNarrow, onClose }: PoseWizardProps) {
  const [arm, setArm] = useArm(asked.arm)
  const [method, setMethod] = useState<'place' | 'points'>(asked.isFrame ? 'points' : 'place')
  const [frame, setFrame] = useState(() => frameOf(asked.value))
  const [pose, setPose] = useState(() => poseOf(asked.value))
  const [cell, setCell] = useState<CellStateFrame>()
  useData({ number: 0, traffic: false, topic: '', fields: [], run: '', goals: '', cell: true }, (message) => {
    if (message.k === 'cell') setCell(message)
  })
  const tool = useTool(arm)
  const place = placeOf(asked.meant(frame), cell)
  const frames = [...new Set([WORLD, ...asked.frames, frame])]
  const unplaced = place ? undefined : `where ${asked.meant(frame) || frame} is, is not known: choose another frame`
  useShownValue(arm, pose && place ? { kind: 'pose', pose: inWorld(pose, place) } : undefined)

  function takeWorld(found: PlacedPose): void {
    if (!place) return
    const seen = seenFrom(found, place)
    setPose({ xyz: roundedTo(seen.xyz), xyzw: roundedTo(seen.xyzw, TURN_DIGITS) })
  }

  /** The pose stays where it is, and is seen from the other frame. */
  function changeFrame(next: string): void {
    const other = placeOf(asked.meant(next), cell)
    if (pose && place && other) {
      const seen = seenFrom(inWorld(pose, place), other)
      setPose({ xyz: roundedTo(seen.xyz), xyzw: roundedTo(seen.xyzw, TURN_DIGITS) })
    }
    setFrame(next)
  }

  const fault = pose ? undefined : method === 'points' ? 'Take or type the three points' : 'Take the present pose, or type one'
  return (
    <WizardFrame
      title={`Teach ${asked.title}`}
      view={view}
      isNarrow={isNarrow}
      fault={fault}
      onUse={() => {
        if (pose) asked.onSet(written(pose, frame, asked.form))
        onClose()
      }}
      onClose={onClose}
    >
      <SegmentedControl
        size="xs"
        aria-label="How it is taught"
        value={method}
        onChange={setMethod}
        data={[
          { value: 'place', label: 'In place' },
          { value: 'points', label: 'By three points' },
        ]}
      />
      <TaughtArm arm={arm} onArm={setArm} jog={jog} />
      {frames.length > 1 && (
        <NativeSelect
          size="xs"
          label="Given in the frame"
          value={frame}
          data={frames.map((each) => ({
            value: each,
            label: asked.meant(each) === each ? each : `${each} (${asked.meant(each) || 'not known'})`,
          }))}
          error={unplaced}
          onChange={(event) => changeFrame(event.currentTarget.value)}
        />
      )}
      {method === 'place' ? (
        <TakePose arm={arm} obstacle={unplaced} tool={tool} onTake={takeWorld} />
      ) : (
        <ThreePoints arm={arm} isFrame={asked.isFrame === true} onMade={takeWorld} />
      )}
      <PoseFields pose={pose} onChange={setPose} />
    </WizardFrame>
  )
}

interface TakePoseProps {
  readonly arm: string
  readonly tool: PlacedPose | undefined
  readonly obstacle: string | undefined
  readonly onTake: (pose: PlacedPose) => void
}

function TakePose({ arm, tool, obstacle, onTake }: TakePoseProps) {
  const absent = useArmObstacle(arm) ?? (tool ? undefined : 'where the tool is, is not known yet')
  return (
    <div>
      <CommandButton
        label="Take the present pose"
        icon={<IconFocusCentered size={15} aria-hidden />}
        obstacle={absent ?? obstacle}
        onPress={() => tool && onTake(tool)}
      />
    </div>
  )
}

interface ThreePointsProps {
  readonly arm: string
  readonly isFrame: boolean
  readonly onMade: (pose: PlacedPose) => void
}

/** A frame by its origin, a point on x and one on the side of y. */
function ThreePoints({ arm, isFrame, onMade }: ThreePointsProps) {
  const [points, setPoints] = useState<Dict<Vector>>({})
  const [isFlipped, setFlipped] = useState(!isFrame)
  const [o, x, y] = ['origin', 'onX', 'onY'].map((name) => lookup(points, name))
  const made = o && x && y ? threePointFrame(o, x, y) : undefined
  const set = (name: string) => (point: Vector) => setPoints({ ...points, [name]: point })
  return (
    <Stack gap={6}>
      <TaughtPoint label="Origin" arm={arm} point={o} onChange={set('origin')} />
      <TaughtPoint label="Point on x" arm={arm} point={x} onChange={set('onX')} />
      <TaughtPoint label="Point on y" arm={arm} point={y} onChange={set('onY')} />
      <Switch
        size="xs"
        label="The tool looks into the plane"
        description="z of the pose points down into it, x stays; off, z is that of the frame"
        checked={isFlipped}
        onChange={(event) => setFlipped(event.currentTarget.checked)}
      />
      <div>
        <CommandButton
          label="Make the pose of the points"
          obstacle={made === undefined ? 'take the three points first' : made.fault}
          onPress={() =>
            made?.value && onMade(isFlipped ? { ...made.value, xyzw: normalised(multiplied(made.value.xyzw, FLIPPED)) } : made.value)
          }
        />
      </div>
      <Refusal>{made?.fault}</Refusal>
      {made?.value && o && x && y && (
        <Text size="xs" c="dimmed" role="status">
          {`The points are ${(distance(o, x) * 1000).toFixed(1)} and ${(distance(o, y) * 1000).toFixed(1)} mm from the origin, and ${degrees(angleAt(o, x, y)).toFixed(2)}° apart: 90° at a square corner.`}
        </Text>
      )}
    </Stack>
  )
}

function PoseFields({ pose, onChange }: { readonly pose: PlacedPose | undefined; readonly onChange: (pose: PlacedPose) => void }) {
  const { xyz, xyzw } = pose ?? { xyz: [0, 0, 0] as Vector, xyzw: NO_TURN }
  return (
    <Stack gap={6}>
      <VectorFields
        label="Position"
        names={['x', 'y', 'z']}
        unit="m"
        values={xyz}
        onChange={([x = 0, y = 0, z = 0]) => onChange({ xyz: [x, y, z], xyzw })}
      />
      <VectorFields
        label="Roll, pitch, yaw"
        names={['r', 'p', 'y']}
        unit="°"
        digits={2}
        values={rollPitchYaw(xyzw).map(degrees)}
        onChange={(angles) => {
          const [r = 0, p = 0, y = 0] = angles.map((angle) => (angle * Math.PI) / 180)
          onChange({ xyz, xyzw: roundedTo(turnOf([r, p, y]), TURN_DIGITS) })
        }}
      />
    </Stack>
  )
}

/** Where a frame is in the world; the world is where it is. */
function placeOf(frame: string, cell: CellStateFrame | undefined): PlacedPose | undefined {
  if (frame === WORLD) return { xyz: [0, 0, 0], xyzw: NO_TURN }
  const pose = cell && lookup(cell.poses, frame)
  return pose && poseFrom([...pose.xyz, ...pose.xyzw])
}

function poseOf(value: unknown): PlacedPose | undefined {
  const fields = fieldsOf(value)
  const xyz = vectorFrom(lookup(fields, 'xyz'))
  if (!xyz) return undefined
  const angles = vectorFrom(lookup(fields, 'rpy'))
  const turn = lookup(fields, 'xyzw')
  const given = Array.isArray(turn) ? poseFrom([...xyz, ...(turn as number[])]) : undefined
  return given ?? { xyz, xyzw: angles ? turnOf(angles) : NO_TURN }
}

function written({ xyz, xyzw }: PlacedPose, frame: string, form: PoseRequest['form']): Dict<unknown> {
  if (form === 'rpy') return { xyz, rpy: roundedTo(rollPitchYaw(xyzw)) }
  return { xyz, xyzw: roundedTo(normalised(xyzw), TURN_DIGITS), ...(frame === WORLD ? {} : { frame }) }
}
