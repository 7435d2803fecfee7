/** All keys of the editor. */
import { Box, Flex, Kbd, SimpleGrid, Text, Title } from '@mantine/core'
import { Dialog } from '../../components/Dialog'
import { TourButton } from '../../components/TourButton'
import { chordText } from '../../document/editing/keys'
import { COMMANDS } from './commands'
import { setEditor, useEditor } from './store'
import classes from './versions.module.css'

const PARTS = ['Document', 'Build', 'Arrange', 'Move around'] as const

export function KeySheet() {
  const isShown = useEditor((s) => s.isSheetShown)
  return (
    <Dialog isOpen={isShown} onClose={() => setEditor({ isSheetShown: false })} title="Keyboard">
      <SimpleGrid minColWidth="19rem" spacing="lg" verticalSpacing="xs" className={classes['wide']} fz="sm">
        {PARTS.map((part) => (
          <section key={part} aria-label={part}>
            <Title order={3} fz="sm" my={6}>
              {part}
            </Title>
            <Flex component="dl" direction="column" gap={6} m={0}>
              {COMMANDS.filter((command) => command.part === part && command.chords.length > 0).map((command) => (
                <Flex key={command.id} align="baseline" gap="xs">
                  <Flex component="dt" wrap="wrap" gap={3} w="8.2rem" flex="none">
                    {command.chords.map((chord) => (
                      <Kbd key={chordText(chord)} size="xs">
                        {chordText(chord)}
                      </Kbd>
                    ))}
                  </Flex>
                  <Box component="dd" m={0}>
                    {command.words}
                  </Box>
                </Flex>
              ))}
            </Flex>
          </section>
        ))}
      </SimpleGrid>
      <Text size="sm" c="dimmed" my="sm">
        Arrow keys go from node to node, Tab through all of them. Commands without a key are in the palette (Ctrl+K). Keys do nothing while
        you write in a field; out of the text leads Esc, then Tab.
      </Text>
      <TourButton onOpened={() => setEditor({ isSheetShown: false })} />
    </Dialog>
  )
}
