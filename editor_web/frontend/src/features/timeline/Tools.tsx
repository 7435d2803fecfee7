/** What can be done with a timeline: play, go from mark to mark, zoom, choose marks, go back to the present. */
import { ActionIcon, Button, Checkbox, Group, NativeSelect, Popover, Stack, Tooltip } from '@mantine/core'
import {
  IconAlertTriangle,
  IconArrowsMaximize,
  IconChartLine,
  IconChevronLeftPipe,
  IconChevronRightPipe,
  IconFilter,
  IconMinus,
  IconPlayerPauseFilled,
  IconPlayerPlayFilled,
  IconPlayerTrackNextFilled,
  IconPlus,
} from '@tabler/icons-react'
import { useState, type ReactNode } from 'react'
import { backToPresent, SPEEDS, useTimeline, type Subject } from '../../api/timeline'
import { MARK_KINDS, MARK_WORDS, type MarkKind } from '../../document/timeline'
import { MarkList, type MarkListProps } from './MarkList'
import { play } from './usePlayback'

export interface ToolsProps {
  readonly subject: Subject
  readonly durationS: number
  readonly width: number
  readonly hasFailures: boolean
  readonly kinds: ReadonlySet<MarkKind>
  readonly onKinds: (kinds: ReadonlySet<MarkKind>) => void
  readonly onJump: (direction: 1 | -1, onlyFailures?: boolean) => void
  readonly onZoom: (factor: number) => void
  readonly onWhole: () => void
  readonly list: MarkListProps
  /** Undefined where there are no curves to be shown. */
  readonly curves: { readonly isShown: boolean; readonly onToggle: () => void } | undefined
}

export function Tools({ subject, durationS, width, hasFailures, kinds, onKinds, onJump, onZoom, onWhole, list, curves }: ToolsProps) {
  const isPlaying = useTimeline((s) => s.isPlaying)
  const speed = useTimeline((s) => s.speed)
  const isPast = useTimeline((s) => s.timeS !== undefined)
  return (
    <Group
      style={{ overflowX: 'auto', scrollbarWidth: 'none' }}
      flex={1}
      gap={2}
      miw={0}
      wrap="nowrap"
      role="toolbar"
      aria-label="Timeline"
    >
      <Tool label="Previous mark (Page up)" onPress={() => onJump(-1)}>
        <IconChevronLeftPipe size={16} />
      </Tool>
      <Tool label={isPlaying ? 'Stop playing (Space)' : 'Play (Space)'} onPress={() => play(subject, durationS)}>
        {isPlaying ? <IconPlayerPauseFilled size={15} /> : <IconPlayerPlayFilled size={15} />}
      </Tool>
      <Tool label="Next mark (Page down)" onPress={() => onJump(1)}>
        <IconChevronRightPipe size={16} />
      </Tool>
      <NativeSelect
        size="xs"
        w="4.7rem"
        flex="none"
        mx={4}
        aria-label="Speed of playing"
        value={String(speed)}
        data={SPEEDS.map((each) => ({ value: String(each), label: `${each}×` }))}
        onChange={(event) => useTimeline.setState({ speed: Number(event.currentTarget.value) })}
      />
      {hasFailures && <LastFailure isWide={width > 560} onPress={() => onJump(-1, true)} />}
      <Group gap={2} wrap="nowrap" ml="auto">
        {isPast && (
          <Button
            variant="light"
            size="compact-sm"
            leftSection={<IconPlayerTrackNextFilled size={14} aria-hidden />}
            onClick={() => backToPresent(subject)}
          >
            {subject.isPast ? 'To the end' : 'Live'}
          </Button>
        )}
        {curves && (
          <Tooltip label="Recorded curves below the lanes" openDelay={300}>
            <ActionIcon
              variant={curves.isShown ? 'light' : 'subtle'}
              {...(!curves.isShown && { color: 'gray' })}
              size="md"
              aria-label="Curves"
              aria-pressed={curves.isShown}
              onClick={curves.onToggle}
            >
              <IconChartLine size={16} />
            </ActionIcon>
          </Tooltip>
        )}
        <MarkList {...list} />
        <MarkMenu kinds={kinds} onKinds={onKinds} />
        <Tool label="Zoom in (+)" onPress={() => onZoom(0.5)}>
          <IconPlus size={16} />
        </Tool>
        <Tool label="Zoom out (−)" onPress={() => onZoom(2)}>
          <IconMinus size={16} />
        </Tool>
        <Tool label="Show the whole run (0)" onPress={onWhole}>
          <IconArrowsMaximize size={16} />
        </Tool>
      </Group>
    </Group>
  )
}

function LastFailure({ isWide, onPress }: { isWide: boolean; onPress: () => void }) {
  const title = 'Go to the failure before this moment, from the present to the last one'
  const icon = <IconAlertTriangle size={14} aria-hidden />
  return isWide ? (
    <Button variant="default" c="var(--failed)" size="compact-sm" title={title} leftSection={icon} onClick={onPress}>
      Last failure
    </Button>
  ) : (
    <ActionIcon variant="default" c="var(--failed)" size="md" aria-label="Last failure" title={title} onClick={onPress}>
      {icon}
    </ActionIcon>
  )
}

function MarkMenu({ kinds, onKinds }: Pick<ToolsProps, 'kinds' | 'onKinds'>) {
  const [isOpen, setOpen] = useState(false)

  function toggle(kind: MarkKind, isOn: boolean): void {
    onKinds(new Set(isOn ? [...kinds, kind] : [...kinds].filter((each) => each !== kind)))
  }

  return (
    <Popover opened={isOpen} onChange={setOpen} position="bottom-end" width={220} shadow="md" trapFocus returnFocus>
      <Popover.Target>
        <ActionIcon
          variant="subtle"
          color="gray"
          size="md"
          aria-label="Choose marks"
          aria-expanded={isOpen}
          title="Choose marks"
          onClick={() => setOpen(!isOpen)}
        >
          <IconFilter size={16} />
        </ActionIcon>
      </Popover.Target>
      <Popover.Dropdown>
        <Stack gap="xs">
          {MARK_KINDS.map((kind) => (
            <Checkbox
              key={kind}
              size="sm"
              label={MARK_WORDS[kind]}
              checked={kinds.has(kind)}
              onChange={(event) => toggle(kind, event.currentTarget.checked)}
            />
          ))}
        </Stack>
      </Popover.Dropdown>
    </Popover>
  )
}

function Tool({ label, onPress, children }: { label: string; onPress: () => void; children: ReactNode }) {
  return (
    <Tooltip label={label} openDelay={300}>
      <ActionIcon variant="subtle" color="gray" size="md" aria-label={label.replace(/ \(.*\)$/, '')} onClick={onPress}>
        {children}
      </ActionIcon>
    </Tooltip>
  )
}
