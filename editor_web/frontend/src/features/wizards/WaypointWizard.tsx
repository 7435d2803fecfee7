/** The waypoints of a motion: taken from the arm one after the other, in order, each with its blend. */
import { Group, NativeSelect, NumberInput, Stack, UnstyledButton } from '@mantine/core'
import { IconFocusCentered } from '@tabler/icons-react'
import { useState, type ReactNode } from 'react'
import { useTeach } from '../../api/teaching'
import type { WaypointRequest } from '../../api/valueWizard'
import { CommandButton } from '../../components/CommandButton'
import { OrderTools } from '../../components/OrderTools'
import { lookup } from '../../document/dict'
import {
  blendOf,
  entryWaypoint,
  ghostOf,
  hasFields,
  jointWaypoint,
  poseWaypoint,
  waypointsFault,
  waypointsOf,
  waypointWords,
  withBlend,
  type Waypoint,
} from '../../document/editing/waypoints'
import { reordered } from '../../document/reorder'
import { TaughtArm, useArm, useArmObstacle, useTool } from './TaughtArm'
import { useShownValue } from './useShownValue'
import { WizardFrame } from './WizardFrame'

interface WaypointWizardProps {
  readonly asked: WaypointRequest
  readonly jog: (arm: string) => ReactNode
  readonly view: ReactNode
  readonly isNarrow: boolean
  readonly onClose: () => void
}

export function WaypointWizard({ asked, jog, view, isNarrow, onClose }: WaypointWizardProps) {
  const [arm, setArm] = useArm(asked.arm)
  const [waypoints, setWaypoints] = useState(() => waypointsOf(asked.value))
  const [chosen, setChosen] = useState(waypoints.length - 1)
  const info = useTeach((s) => s.arms?.find((each) => each.name === arm))
  const shown = waypoints[chosen]
  useShownValue(arm, {
    kind: 'waypoints',
    points: waypoints.flatMap(({ place }) => (place ? [place] : [])),
    ghost: shown && ghostOf(shown),
  })

  /** Behind the chosen one, which is the last one as long as nobody chooses another. */
  function add(waypoint: Waypoint): void {
    setWaypoints(waypoints.toSpliced(chosen + 1, 0, waypoint))
    setChosen(chosen + 1)
  }

  function move(at: number, by: 1 | -1): void {
    setWaypoints(reordered(waypoints, at, by))
    setChosen(at + by)
  }

  return (
    <WizardFrame
      title={`Teach ${asked.title}`}
      view={view}
      isNarrow={isNarrow}
      fault={waypointsFault(waypoints, info?.joint_names.length)}
      onUse={() => {
        asked.onSet(waypoints.map(({ value }) => value))
        onClose()
      }}
      onClose={onClose}
    >
      <TaughtArm arm={arm} onArm={setArm} jog={jog} />
      <AddWaypoint arm={arm} entries={asked.entries} onAdd={add} />
      <Stack gap={4} mah="18rem" style={{ overflowY: 'auto' }} role="group" aria-label="Waypoints">
        {waypoints.map((waypoint, at) => (
          <WaypointRow
            // oxlint-disable-next-line react/no-array-index-key -- waypoints may be equal
            key={at}
            at={at}
            waypoint={waypoint}
            isChosen={at === chosen}
            isLast={at === waypoints.length - 1}
            onChoose={() => setChosen(at)}
            onMove={(by) => move(at, by)}
            onDelete={() => {
              setWaypoints(waypoints.toSpliced(at, 1))
              setChosen(Math.min(chosen, waypoints.length - 2))
            }}
            onChange={(next) => setWaypoints(waypoints.with(at, next))}
          />
        ))}
      </Stack>
    </WizardFrame>
  )
}

interface AddWaypointProps {
  readonly arm: string
  readonly entries: WaypointRequest['entries']
  readonly onAdd: (waypoint: Waypoint) => void
}

function AddWaypoint({ arm, entries, onAdd }: AddWaypointProps) {
  const tool = useTool(arm)
  const joints = useTeach((s) => lookup(s.now, arm)?.joints)
  const absent = useArmObstacle(arm)
  return (
    <Group gap="xs" align="end">
      <CommandButton
        label="Add the present joints"
        icon={<IconFocusCentered size={15} aria-hidden />}
        obstacle={absent ?? (joints ? undefined : 'its joints are not known yet')}
        onPress={() => joints && onAdd(jointWaypoint(joints, tool))}
      />
      <CommandButton
        label="Add the present pose"
        icon={<IconFocusCentered size={15} aria-hidden />}
        obstacle={absent ?? (tool ? undefined : 'where the tool is, is not known yet')}
        onPress={() => tool && onAdd(poseWaypoint(tool))}
      />
      {entries.length > 0 && (
        <NativeSelect
          size="xs"
          aria-label="Add an entry"
          value=""
          data={[
            { value: '', label: 'Add an entry' },
            ...entries.map(({ kind, name }, at) => ({ value: String(at), label: `${name} (${kind})` })),
          ]}
          onChange={(event) => {
            const entry = event.currentTarget.value === '' ? undefined : entries[Number(event.currentTarget.value)]
            if (entry) onAdd(entryWaypoint(entry.kind, entry.name))
          }}
        />
      )}
    </Group>
  )
}

interface WaypointRowProps {
  readonly at: number
  readonly waypoint: Waypoint
  readonly isChosen: boolean
  readonly isLast: boolean
  readonly onChoose: () => void
  readonly onMove: (by: 1 | -1) => void
  readonly onDelete: () => void
  readonly onChange: (waypoint: Waypoint) => void
}

/** By the index that findings and messages name it with. */
function WaypointRow({ at, waypoint, isChosen, isLast, onChoose, onMove, onDelete, onChange }: WaypointRowProps) {
  return (
    <Group gap={4} wrap="nowrap">
      <UnstyledButton
        flex={1}
        miw={0}
        px={4}
        fz="xs"
        ff="monospace"
        aria-pressed={isChosen}
        title="Show it"
        fw={isChosen ? 700 : 400}
        onClick={onChoose}
      >
        {at}: {waypointWords(waypoint)}
      </UnstyledButton>
      <NumberInput
        size="xs"
        w="6.5rem"
        flex="none"
        hideControls
        aria-label={`Blend of waypoint ${at}`}
        title="How near the tool passes; 0 stops there"
        min={0}
        max={1}
        decimalScale={4}
        disabled={isLast || !hasFields(waypoint)}
        placeholder={isLast ? 'stops' : 'default'}
        value={isLast ? '' : (blendOf(waypoint) ?? '')}
        onChange={(next) => {
          // `0.` is text until its next digit is typed.
          if (typeof next === 'number' || next === '') onChange(withBlend(waypoint, next === '' ? undefined : next))
        }}
        rightSection="m"
      />
      <OrderTools name={`waypoint ${at}`} isFirst={at === 0} isLast={isLast} onMove={onMove} onDelete={onDelete} />
    </Group>
  )
}
