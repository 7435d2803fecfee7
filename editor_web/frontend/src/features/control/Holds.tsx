/** Everything that can hold the run: its breakpoints and locks, in one list. */
import { Box, CloseButton, Group, Switch, Text } from '@mantine/core'
import { IconBookmarkOff } from '@tabler/icons-react'
import { editBreakpoints, useBreakpoints } from '../../api/breakpoints'
import { useLive } from '../../api/live'
import { Empty } from '../../components/Empty'
import { TextButton } from '../../components/TextButton'
import { breakpointWords, replaced } from '../../document/breakpoints'
import { lookup } from '../../document/dict'
import type { Commands } from './useCommands'

export function Holds({ commands, onShow }: { commands: Commands; onShow: (path: string) => void }) {
  const breakpoints = useBreakpoints()
  const locks = useLive((s) => s.control?.locks)
  const reasons = useLive((s) => s.lockReasons)
  if (breakpoints.length === 0 && !locks?.length) {
    return (
      <Empty icon={<IconBookmarkOff size={26} stroke={1.4} aria-hidden />} title="Nothing holds this behavior">
        Click the dot at the corner of a node to pause there, or select a node for conditions and locks.
      </Empty>
    )
  }
  return (
    <ul className="plain-list">
      {breakpoints.map((each) => (
        <Hold
          key={`${each.path}|${each.when}`}
          path={each.path}
          words={breakpointWords(each)}
          color="var(--failed)"
          onShow={onShow}
          removal={`Remove the breakpoint ${each.when} ${each.path}`}
          onRemove={() => void editBreakpoints((list) => list.filter((one) => one.path !== each.path || one.when !== each.when))}
          isOn={each.enabled}
          onSwitch={(enabled) => void editBreakpoints((list) => replaced(list, { ...each, enabled }))}
        />
      ))}
      {locks?.map((path) => (
        <Hold
          key={path}
          path={path}
          words={`locked${lookup(reasons, path) ? `: ${lookup(reasons, path)}` : ''}`}
          color="var(--stopped)"
          onShow={onShow}
          removal={`Unlock ${path}`}
          onRemove={() => void commands.unlock(path)}
        />
      ))}
    </ul>
  )
}

interface HoldProps {
  readonly path: string
  readonly words: string
  readonly color: string
  readonly onShow: (path: string) => void
  readonly removal: string
  readonly onRemove: () => void
  /** Given for what can be switched off and stays in the list. */
  readonly isOn?: boolean
  readonly onSwitch?: (isOn: boolean) => void
}

function Hold({ path, words, color, onShow, removal, onRemove, isOn = true, onSwitch }: HoldProps) {
  return (
    <Group component="li" gap="2xs" py="4xs" fz="0.84rem" wrap="nowrap">
      <Box
        w={10}
        h={10}
        flex="none"
        bdrs="xl"
        bg={isOn ? color : 'transparent'}
        bd={`2px solid ${color}`}
        style={{ forcedColorAdjust: 'none' }}
        aria-hidden
      />
      <Text span inherit flex={1} miw={0}>
        <TextButton label={`${path}, ${words}`} onPress={() => onShow(path)}>
          {path}
        </TextButton>{' '}
        <Text span inherit c="var(--quiet)">
          {words}
        </Text>
      </Text>
      {onSwitch && (
        <Switch
          size="xs"
          aria-label={`Enabled: ${path}, ${words}`}
          checked={isOn}
          onChange={(event) => onSwitch(event.currentTarget.checked)}
        />
      )}
      <CloseButton size="sm" aria-label={removal} onClick={onRemove} />
    </Group>
  )
}
