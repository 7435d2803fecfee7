/** The page on which arms are taught: the cell, jogging and leading, captures, entries, triggers and buttons. */
import { Box, Button, Flex, VisuallyHidden } from '@mantine/core'
import { useEffect, useState } from 'react'
import { Group, Panel as Pane } from 'react-resizable-panels'
import { connectTeach, endPreview, useTeach } from '../api/teaching'
import { mayMoveDevices, useMayMove } from '../api/realDevices'
import { hasCellView } from '../api/session'
import type { ArmInfo, SessionBody } from '../api/types'
import { CommandButton } from '../components/CommandButton'
import { Empty } from '../components/Empty'
import { OpenedTabs } from '../components/OpenedTabs'
import { Panel } from '../components/Panel'
import { Splitter } from '../components/Splitter'
import { CellFrame } from '../features/cell/CellFrame'
import { HandleMenu } from '../features/cell/HandleMenu'
import { ShowMenu } from '../features/cell/ShowMenu'
import { RobotStrip } from '../features/robots/RobotStrip'
import { ArmHead } from '../features/teaching/ArmHead'
import { ButtonPanel } from '../features/teaching/ButtonPanel'
import { CaptureList } from '../features/teaching/CaptureList'
import { EntryList } from '../features/teaching/EntryList'
import { JogPanel } from '../features/teaching/JogPanel'
import { LeadPanel } from '../features/teaching/LeadPanel'
import { TabBody } from '../features/teaching/TabBody'
import { TriggerTable } from '../features/teaching/TriggerTable'
import { useButtons } from '../features/teaching/useButtons'

interface TeachPageProps {
  readonly session: SessionBody | undefined
  readonly isNarrow: boolean
}

export function TeachPage({ session, isNarrow }: TeachPageProps) {
  const arms = useTeach((s) => s.arms)
  const isPreviewing = useTeach((s) => s.isPreviewing)
  const [chosen, setChosen] = useState('')
  useEffect(connectTeach, [])
  useButtons()
  const mayMove = useMayMove()
  const arm = arms?.find((each) => each.name === chosen) ?? arms?.[0]
  const cell = (
    <Panel
      title="Cell"
      hasIcons
      tools={
        <>
          <Box flex={1} />
          {hasCellView(session) && isPreviewing && <CommandButton label="Hide the ghosts" tone="quiet" onPress={endPreview} />}
          {hasCellView(session) && <ShowMenu />}
          {hasCellView(session) && session?.role === 'operator' && mayMove && <HandleMenu />}
        </>
      }
      foot={<RobotStrip />}
    >
      <CellFrame />
    </Panel>
  )
  return (
    <Flex direction="column" flex={1} mih={0} style={{ overflow: isNarrow ? 'auto' : undefined }}>
      <VisuallyHidden component="h1">Teach</VisuallyHidden>
      {arms === undefined ? (
        <div role="status" aria-label="Loading" />
      ) : arm === undefined ? (
        <Empty title="No arm to teach">Serve a cell with arms: flexcell serve --cell behaviors/cells/dual_panda.yaml</Empty>
      ) : (
        <>
          <ArmHead arms={arms} arm={arm} onArm={setChosen} />
          {isNarrow ? (
            <div style={{ flex: 'none' }}>
              <div style={{ height: '42vh' }}>{cell}</div>
              <Tabs arms={arms} arm={arm} mayMove={mayMove} />
            </div>
          ) : (
            <Group orientation="horizontal" style={{ flex: 1, minHeight: 0 }}>
              <Pane id="teach-cell" defaultSize="56%" minSize="25%">
                {cell}
              </Pane>
              <Splitter label="Width of the cell" />
              <Pane id="teach-tabs" defaultSize="44%" minSize="30%">
                <Tabs arms={arms} arm={arm} mayMove={mayMove} />
              </Pane>
            </Group>
          )}
        </>
      )}
    </Flex>
  )
}

interface TabsProps {
  readonly arms: readonly ArmInfo[]
  readonly arm: ArmInfo
  readonly mayMove: boolean
}

function Tabs({ arms, arm, mayMove }: TabsProps) {
  const names = arms.map((each) => each.name)
  const bodies = {
    Move: !mayMove ? (
      <Empty title="This cell has real devices">
        They move once you have said that they may.
        <Button size="xs" mt="sm" onClick={() => void mayMoveDevices()}>
          Let them move
        </Button>
      </Empty>
    ) : (
      <>
        <JogPanel key={arm.name} arm={arm} />
        <LeadPanel key={`lead ${arm.name}`} arm={arm} />
      </>
    ),
    Captures: <CaptureList arm={arm.name} />,
    Entries: <EntryList arm={arm.name} />,
    Triggers: <TriggerTable arms={names} />,
    Buttons: <ButtonPanel />,
  }
  const shown = Object.fromEntries(Object.entries(bodies).map(([name, body]) => [name, <TabBody key={name}>{body}</TabBody>]))
  return <OpenedTabs label="Teaching" bodies={shown} />
}
