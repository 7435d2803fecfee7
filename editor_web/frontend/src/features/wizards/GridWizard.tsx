/** The places of a pallet as a list of poses: three corners taken with the tool, and how many there are each way. */
import { Group, NumberInput, Paper, Stack, Switch, Text } from '@mantine/core'
import { IconFocusCentered } from '@tabler/icons-react'
import { useState } from 'react'
import { CommandButton } from '../../components/CommandButton'
import { lookup, type Dict } from '../../document/dict'
import { gridPoints, roundedTo, turnOf, type Quaternion, type Vector } from '../../document/poses'
import type { PlainWizardProps } from './JointWizard'
import { poseWords, TaughtArm, useArm, useArmObstacle, useTool } from './TaughtArm'
import { TaughtPoint } from './TaughtPoint'
import { useShownValue } from './useShownValue'
import { WizardFrame } from './WizardFrame'

/** A tool that looks down. */
const DOWN = turnOf([Math.PI, 0, 0])
const MOST = 50

export function GridWizard({ asked, jog, view, isNarrow, onClose }: PlainWizardProps) {
  const [arm, setArm] = useArm(asked.arm)
  const [corners, setCorners] = useState<Dict<Vector>>({})
  const [turn, setTurn] = useState<Quaternion>(DOWN)
  const [counts, setCounts] = useState({ columns: 3, rows: 2 })
  const [isSerpentine, setSerpentine] = useState(false)
  const [first, rowEnd, columnEnd] = ['first', 'rowEnd', 'columnEnd'].map((name) => lookup(corners, name))
  const tool = useTool(arm)
  const obstacle = useArmObstacle(arm) ?? (tool ? undefined : 'where the tool is, is not known yet')
  const made =
    first && (rowEnd || counts.columns === 1) && (columnEnd || counts.rows === 1)
      ? gridPoints({ first, rowEnd: rowEnd ?? first, columnEnd: columnEnd ?? first }, counts.columns, counts.rows, isSerpentine)
      : undefined
  const points = made?.value ?? []
  useShownValue(arm, points.length > 0 ? { kind: 'points', points } : undefined)
  const set = (name: string) => (point: Vector) => setCorners({ ...corners, [name]: point })
  return (
    <WizardFrame
      title={`Teach ${asked.title}`}
      view={view}
      isNarrow={isNarrow}
      fault={made === undefined ? 'Take or type the corners' : made.fault}
      onUse={() => {
        asked.onSet(points.map((xyz) => ({ xyz: roundedTo(xyz), xyzw: roundedTo(turn, 5) })))
        onClose()
      }}
      onClose={onClose}
    >
      <TaughtArm arm={arm} onArm={setArm} jog={jog} />
      <Stack gap={6}>
        <TaughtPoint label="First place" arm={arm} point={first} onChange={set('first')} />
        {counts.columns > 1 && <TaughtPoint label="End of the row" arm={arm} point={rowEnd} onChange={set('rowEnd')} />}
        {counts.rows > 1 && <TaughtPoint label="Last row" arm={arm} point={columnEnd} onChange={set('columnEnd')} />}
      </Stack>
      <Group gap="xs" align="end">
        <Count label="Columns" value={counts.columns} onChange={(columns) => setCounts({ ...counts, columns })} />
        <Count label="Rows" value={counts.rows} onChange={(rows) => setCounts({ ...counts, rows })} />
        <Switch
          size="xs"
          mb={7}
          label="Every other row back"
          checked={isSerpentine}
          onChange={(event) => setSerpentine(event.currentTarget.checked)}
        />
      </Group>
      <Group gap="xs">
        <CommandButton
          label="Take the present turn of the tool"
          hint="All places have it"
          icon={<IconFocusCentered size={15} aria-hidden />}
          obstacle={obstacle}
          onPress={() => tool && setTurn(roundedTo(tool.xyzw, 5))}
        />
        <Text size="xs" c="dimmed">
          {turn === DOWN ? 'The tool looks down' : 'The turn is taken from the tool'}
        </Text>
      </Group>
      {points.length > 0 && (
        <Paper withBorder p="xs" mah="9rem" style={{ overflowY: 'auto' }} role="group" aria-label="Places" tabIndex={0}>
          {points.map((xyz, at) => (
            <Text key={xyz.join()} size="xs" ff="monospace">
              {at + 1}: {poseWords({ xyz, xyzw: turn })}
            </Text>
          ))}
        </Paper>
      )}
    </WizardFrame>
  )
}

function Count({ label, value, onChange }: { readonly label: string; readonly value: number; readonly onChange: (value: number) => void }) {
  return (
    <NumberInput
      size="xs"
      w="5.5rem"
      label={label}
      min={1}
      max={MOST}
      allowDecimal={false}
      value={value}
      onChange={(next) => typeof next === 'number' && next >= 1 && onChange(next)}
    />
  )
}
